#include <samewhere/train/onnx_graph.hpp>

namespace samewhere::train {
namespace {

constexpr int kIrVersion = 7;

}  // namespace

onnx::ModelProto empty_model(int operator_set, const std::string& description) {
  onnx::ModelProto model;
  model.set_ir_version(kIrVersion);
  model.set_producer_name("samewhere");
  model.set_doc_string(description);
  model.add_opset_import()->set_version(operator_set);
  return model;
}

void add_tensor(onnx::GraphProto& graph, const std::string& name,
                std::span<const std::int64_t> shape, const std::vector<float>& numbers) {
  onnx::TensorProto& tensor = *graph.add_initializer();
  tensor.set_name(name);
  tensor.set_data_type(onnx::TensorProto::FLOAT);
  for (const std::int64_t side : shape) tensor.add_dims(side);
  tensor.set_raw_data(numbers.data(), numbers.size() * sizeof(float));
}

void add_sizes(onnx::NodeProto& node, const std::string& name,
               std::initializer_list<std::int64_t> sizes) {
  onnx::AttributeProto& attribute = *node.add_attribute();
  attribute.set_name(name);
  attribute.set_type(onnx::AttributeProto::INTS);
  for (const std::int64_t size : sizes) attribute.add_ints(size);
}

void add_shape(onnx::ValueInfoProto& value, const std::string& name,
               std::initializer_list<std::int64_t> shape) {
  value.set_name(name);
  auto& tensor = *value.mutable_type()->mutable_tensor_type();
  tensor.set_elem_type(onnx::TensorProto::FLOAT);
  for (const std::int64_t side : shape) tensor.mutable_shape()->add_dim()->set_dim_value(side);
}

void add_shape_tensor(onnx::GraphProto& graph, const std::string& name,
                      const std::vector<std::int64_t>& numbers) {
  onnx::TensorProto& tensor = *graph.add_initializer();
  tensor.set_name(name);
  tensor.set_data_type(onnx::TensorProto::INT64);
  tensor.add_dims(static_cast<std::int64_t>(numbers.size()));
  tensor.set_raw_data(numbers.data(), numbers.size() * sizeof(std::int64_t));
}

void add_number(onnx::NodeProto& node, const std::string& name, float number) {
  onnx::AttributeProto& attribute = *node.add_attribute();
  attribute.set_name(name);
  attribute.set_type(onnx::AttributeProto::FLOAT);
  attribute.set_f(number);
}

void add_whole_number(onnx::NodeProto& node, const std::string& name, std::int64_t number) {
  onnx::AttributeProto& attribute = *node.add_attribute();
  attribute.set_name(name);
  attribute.set_type(onnx::AttributeProto::INT);
  attribute.set_i(number);
}

// x / (bias + alpha / size * sum of squares)^beta, the sum over as many channels as reach all from
// any.
void add_response_norm(Chain& chain, const std::string& name, int num_channels, float floor) {
  onnx::NodeProto& node = chain.add("LRN", name);
  const int size = 2 * num_channels - 1;
  add_whole_number(node, "size", size);
  add_number(node, "alpha", static_cast<float>(size));
  add_number(node, "beta", 0.5F);
  add_number(node, "bias", floor);
}

}  // namespace samewhere::train
