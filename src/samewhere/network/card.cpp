#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/network/card.hpp>

namespace samewhere::network {
namespace {

using Json = nlohmann::json;

constexpr double kMaxSide = 4096.0;

// The object "input" of a card.
class CardReader {
 public:
  explicit CardReader(std::filesystem::path path) : path_(std::move(path)) {
    const Json card = Json::parse(core::read_file(path_), nullptr, false);
    if (card.is_discarded() || !card.is_object() || !card.contains("input") ||
        !card["input"].is_object()) {
      throw core::InputError(path_.string() + ": expected JSON with an object \"input\"");
    }
    input_ = card["input"];
  }

  bool has(const char* key) const { return input_.contains(key); }

  std::string text(const char* key) const {
    if (!has(key) || !input_[key].is_string()) fail(key, "a text");
    return input_[key].get<std::string>();
  }

  Colour colour() const {
    const std::string word = text("colour");
    if (word == "rgb") return Colour::kRgb;
    if (word != "bgr") fail("colour", "rgb or bgr");
    return Colour::kBgr;
  }

  int side(const char* key) const {
    const bool is_side = has(key) && input_[key].is_number_integer() && input_[key] >= 1 &&
                         input_[key].get<double>() <= kMaxSide;
    if (!is_side) fail(key, "a number of pixels");
    return input_[key].get<int>();
  }

  // One number for all channels, or one each.
  std::array<double, 3> numbers(const char* key, double absent) const {
    std::array<double, 3> values{absent, absent, absent};
    if (!has(key)) return values;
    const Json& given = input_[key];
    if (!given.is_number() && (!given.is_array() || given.size() != values.size()))
      fail(key, "one number or three");
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Json& number = given.is_array() ? given[i] : given;
      if (!number.is_number()) fail(key, "one number or three");
      values[i] = number.get<double>();
    }
    return values;
  }

  PictureFormat picture(cv::Size size_px) const {
    return {.colour = colour(),
            .size_px = size_px,
            .mean = numbers("mean", 0.0),
            .scale = numbers("scale", 1.0)};
  }

 private:
  [[noreturn]] void fail(const char* key, const char* expected) const {
    throw core::InputError(fmt::format("{}: input.{} is {}; expected {}", path_.string(), key,
                                       has(key) ? input_[key].dump() : "missing", expected));
  }

  std::filesystem::path path_;
  Json input_;
};

}  // namespace

std::filesystem::path card_path(std::filesystem::path network) {
  return network.replace_extension(".json");
}

InputCard read_input_card(const NetworkFile& network) {
  const std::filesystem::path path = card_path(network.path);
  if (!core::is_there(path)) {
    throw core::InputError(fmt::format(
        "{}: the network's input {} is 1x{}x{}x{}; expected a card {} beside it that says how a "
        "picture becomes that (src/samewhere/describe/README.md)",
        network.path.string(), network.input_name, network.num_channels, network.input_px.height,
        network.input_px.width, path.filename().string()));
  }
  const CardReader card(path);
  if (card.has("trunk")) {
    const cv::Size size_px(card.side("columns"), card.side("rows"));
    return {.picture = {},
            .trunk = TrunkSpec{card.text("trunk"), card.text("layer"), card.picture(size_px)}};
  }
  if (network.num_channels != 3) {
    throw core::InputError(
        fmt::format("{}: input.trunk is missing; expected one for {}, whose input has {} channels",
                    path.string(), network.path.filename().string(), network.num_channels));
  }
  return {.picture = card.picture(network.input_px), .trunk = std::nullopt};
}

}  // namespace samewhere::network
