#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/model_file.hpp>
#include <samewhere/network/network_file.hpp>

namespace samewhere::network {
namespace {

// An ONNX file is a protocol-buffer message ModelProto. Only the ends of its graph are read here,
// by the field numbers of onnx.proto (ONNX 1.0 and later); the layers are the backend's business.
constexpr int kModelGraph = 7;
constexpr int kModelOpset = 8;
constexpr int kGraphInitializer = 5;
constexpr int kGraphInput = 11;
constexpr int kGraphOutput = 12;
constexpr int kTensorName = 8;
constexpr int kValueName = 1;
constexpr int kValueType = 2;
constexpr int kTypeTensor = 1;
constexpr int kTensorElement = 1;
constexpr int kTensorShape = 2;
constexpr int kShapeDimension = 1;
constexpr int kDimensionValue = 1;
constexpr std::uint64_t kFloatElement = 1;
constexpr std::uint64_t kMaxSide_px = 4096;
constexpr std::uint64_t kMaxChannels = 8192;

// One field of a message: a number, or bytes (text, or a message within).
struct Field {
  int id = 0;
  std::uint64_t number = 0;
  std::string_view bytes;
};
using Message = std::vector<Field>;

// Takes the fields of a message off its bytes, front to back.
class MessageReader {
 public:
  MessageReader(std::string_view bytes, const std::filesystem::path& path)
      : rest_(bytes), path_(path) {}

  Message fields() {
    Message message;
    while (!rest_.empty()) message.push_back(field());
    return message;
  }

 private:
  // Kinds of fields on the wire.
  enum Wire : unsigned { kVarint = 0, kEightBytes = 1, kBytes = 2, kFourBytes = 5 };

  Field field() {
    const std::uint64_t key = varint();
    Field field{.id = static_cast<int>(key >> 3)};
    switch (key & 7U) {
      case kVarint:
        field.number = varint();
        break;
      case kEightBytes:
        take(8);
        break;
      case kBytes:
        field.bytes = take(varint());
        break;
      case kFourBytes:
        take(4);
        break;
      default:
        fail();
    }
    return field;
  }

  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const auto byte = static_cast<unsigned char>(take(1).front());
      value |= std::uint64_t{byte & 0x7FU} << shift;
      if ((byte & 0x80U) == 0) return value;
    }
    fail();
  }

  std::string_view take(std::uint64_t count) {
    if (count > rest_.size()) fail();
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(count));
    rest_.remove_prefix(taken.size());
    return taken;
  }

  [[noreturn]] void fail() const {
    throw core::InputError(path_.string() + ": is cut short or no ONNX file; expected a network");
  }

  std::string_view rest_;
  const std::filesystem::path& path_;
};

const Field* find(const Message& message, int id) {
  const auto found = std::find_if(message.begin(), message.end(),
                                  [id](const Field& field) { return field.id == id; });
  return found == message.end() ? nullptr : &*found;
}

// An input or output of the graph.
struct End {
  std::string name;
  bool is_float = false;
  std::vector<std::optional<std::uint64_t>> shape;  // nothing: free
};

class GraphReader {
 public:
  explicit GraphReader(const NetworkFile& network) : path_(network.path) {
    const Message model = fields(network.bytes);
    const Field* const graph = find(model, kModelGraph);
    if (graph == nullptr || find(model, kModelOpset) == nullptr) {
      throw core::InputError(path_.string() +
                             ": is cut short or no ONNX file: it has no graph or no opset");
    }
    graph_ = fields(graph->bytes);
  }

  // The only end of its kind that is no stored weight.
  End only_end(int id, std::string_view kind) const {
    const std::set<std::string_view> weights = weight_names();
    std::vector<End> ends;
    for (const Field& field : graph_) {
      if (field.id != id) continue;
      End end = read_end(field.bytes);
      if (!weights.contains(end.name)) ends.push_back(std::move(end));
    }
    if (ends.size() != 1) {
      throw core::InputError(fmt::format("{}: the network has {} {}s; expected one", path_.string(),
                                         ends.size(), kind));
    }
    return ends.front();
  }

 private:
  Message fields(std::string_view bytes) const { return MessageReader(bytes, path_).fields(); }

  Message message_in(const Message& message, int id) const {
    const Field* const field = find(message, id);
    return field == nullptr ? Message{} : fields(field->bytes);
  }

  // Old files list the weights among the inputs.
  std::set<std::string_view> weight_names() const {
    std::set<std::string_view> names;
    for (const Field& field : graph_) {
      if (field.id != kGraphInitializer) continue;
      const Message tensor = fields(field.bytes);
      if (const Field* const name = find(tensor, kTensorName)) names.insert(name->bytes);
    }
    return names;
  }

  End read_end(std::string_view bytes) const {
    const Message value = fields(bytes);
    const Message tensor = message_in(message_in(value, kValueType), kTypeTensor);
    const Field* const name = find(value, kValueName);
    const Field* const element = find(tensor, kTensorElement);
    End end{.name = std::string(name == nullptr ? "" : name->bytes),
            .is_float = element != nullptr && element->number == kFloatElement};
    for (const Field& field : message_in(tensor, kTensorShape)) {
      if (field.id != kShapeDimension) continue;
      const Message dimension = fields(field.bytes);
      const Field* const number = find(dimension, kDimensionValue);
      end.shape.push_back(number == nullptr ? std::nullopt : std::optional(number->number));
    }
    return end;
  }

  const std::filesystem::path& path_;
  Message graph_;
};

std::string shape_text(const End& end) {
  std::vector<std::string> sizes;
  for (const auto& size : end.shape) sizes.push_back(size ? std::to_string(*size) : "?");
  return fmt::format("{}{}", fmt::join(sizes, "x"), end.is_float ? "" : " not of floats");
}

bool is_picture(const End& end) {
  const auto is_at_most = [](std::optional<std::uint64_t> size, std::uint64_t max) {
    return size && *size >= 1 && *size <= max;
  };
  return end.is_float && end.shape.size() == 4 && end.shape[0].value_or(1) == 1 &&
         is_at_most(end.shape[1], kMaxChannels) && is_at_most(end.shape[2], kMaxSide_px) &&
         is_at_most(end.shape[3], kMaxSide_px);
}

}  // namespace

std::filesystem::path find_network(const std::string& setting, const std::string& file) {
  return core::find_model(setting, file, "an ONNX network");
}

NetworkFile read_network(const std::filesystem::path& path) {
  return parse_network(path, core::read_file(path, core::kNetworkLimit));
}

NetworkFile parse_network(const std::filesystem::path& path, std::string bytes) {
  NetworkFile network{.path = path, .bytes = std::move(bytes)};
  network.checksum = core::checksum(network.bytes);
  const GraphReader graph(network);
  const End input = graph.only_end(kGraphInput, "input");
  const End output = graph.only_end(kGraphOutput, "output");
  if (!is_picture(input)) {
    throw core::InputError(fmt::format(
        "{}: the network's input {} is {}; expected one picture, 1xCxHxW with H and W at most {}",
        path.string(), input.name, shape_text(input), kMaxSide_px));
  }
  network.input_name = input.name;
  network.output_name = output.name;
  network.num_channels = static_cast<int>(*input.shape[1]);
  network.input_px = cv::Size(static_cast<int>(*input.shape[3]), static_cast<int>(*input.shape[2]));
  return network;
}

cv::Mat as_blob(const cv::Mat& input, const NetworkFile& network) {
  const std::vector<int> shape{1, network.num_channels, network.input_px.height,
                               network.input_px.width};
  const bool is_blob = input.dims == 4 && std::equal(shape.begin(), shape.end(), input.size.p);
  const bool is_picture =
      input.dims == 2 && network.num_channels == 1 && input.size() == network.input_px;
  core::require(input.type() == CV_32FC1 && (is_blob || is_picture),
                "a network gets the picture it was made for");
  return (input.isContinuous() ? input : input.clone()).reshape(1, shape);
}

void require_row(const NetworkFile& network, const std::vector<std::int64_t>& output_shape) {
  if (output_shape.size() == 2 && output_shape[0] == 1 && output_shape[1] >= 1) return;
  throw core::InputError(fmt::format("{}: the network's output {} is {}; expected one vector, 1xN",
                                     network.path.string(), network.output_name,
                                     fmt::join(output_shape, "x")));
}

}  // namespace samewhere::network
