#include <cstdint>
#include <span>

#include <onnx/onnx_pb.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/train/onnx_file.hpp>

namespace samewhere::train {
namespace {

constexpr int kIrVersion = 7;
constexpr int kOperatorSet = 11;

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

// Nodes are chained: each takes what the last one gave.
class Chain {
 public:
  Chain(onnx::GraphProto& graph, std::string first) : graph_(graph), last_(std::move(first)) {}

  onnx::NodeProto& add(const std::string& type, const std::string& output) {
    onnx::NodeProto& node = *graph_.add_node();
    node.set_op_type(type);
    node.set_name(output);
    node.add_input(last_);
    node.add_output(output);
    last_ = output;
    return node;
  }

 private:
  onnx::GraphProto& graph_;
  std::string last_;
};

void add_convolution(onnx::GraphProto& graph, Chain& chain, const std::string& name,
                     const Convolution& convolution) {
  const ConvolutionPlan& plan = convolution.plan;
  const std::int64_t kernel = plan.kernel_px;
  const std::int64_t stride = plan.stride_px;
  const std::int64_t padding = plan.padding_px;
  const std::int64_t weights_shape[] = {plan.num_outputs, plan.num_inputs, kernel, kernel};
  const std::int64_t biases_shape[] = {plan.num_outputs};
  add_tensor(graph, name + "_weights", weights_shape, convolution.weights);
  add_tensor(graph, name + "_biases", biases_shape, convolution.biases);
  onnx::NodeProto& node = chain.add("Conv", name);
  node.add_input(name + "_weights");
  node.add_input(name + "_biases");
  add_sizes(node, "kernel_shape", {kernel, kernel});
  add_sizes(node, "strides", {stride, stride});
  add_sizes(node, "pads", {padding, padding, padding, padding});
}

void add_pooling(Chain& chain, const std::string& type, const std::string& name, int side,
                 int stride) {
  onnx::NodeProto& node = chain.add(type, name);
  add_sizes(node, "kernel_shape", {side, side});
  add_sizes(node, "strides", {stride, stride});
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
void add_response_norm(Chain& chain, int num_channels) {
  onnx::NodeProto& node = chain.add("LRN", "response");
  const int size = 2 * num_channels - 1;
  add_whole_number(node, "size", size);
  add_number(node, "alpha", static_cast<float>(size));
  add_number(node, "beta", 0.5F);
  add_number(node, "bias", kResponseFloor);
}

void add_nodes(onnx::GraphProto& graph, const Encoder& encoder) {
  Chain chain(graph, "image");
  const std::size_t num_convolutions = encoder.convolutions.size();
  for (std::size_t i = 0; i < num_convolutions; ++i) {
    const std::string number = std::to_string(i + 1);
    add_convolution(graph, chain, "convolution" + number, encoder.convolutions[i]);
    if (i + 1 == num_convolutions) break;
    chain.add("Relu", "relu" + number);
    add_pooling(chain, "MaxPool", "maximum" + number, 2, 2);
    if (i == 0) add_response_norm(chain, encoder.convolutions[i].plan.num_outputs);
  }
  add_pooling(chain, "AveragePool", "mean", kCodeWindow, kCodeStep);
  chain.add("Sigmoid", "bounded");
  add_whole_number(chain.add("Flatten", "code"), "axis", 1);
}

onnx::ModelProto empty_model(const std::string& description) {
  onnx::ModelProto model;
  model.set_ir_version(kIrVersion);
  model.set_producer_name("samewhere");
  model.set_doc_string(description);
  model.add_opset_import()->set_version(kOperatorSet);
  return model;
}

}  // namespace

std::string onnx_bytes(const Encoder& encoder, const std::string& description) {
  onnx::ModelProto model = empty_model(description);
  onnx::GraphProto& graph = *model.mutable_graph();
  graph.set_name("encoder");
  add_shape(*graph.add_input(), "image", {1, 1, encoder.input_px.height, encoder.input_px.width});
  add_nodes(graph, encoder);
  add_shape(*graph.add_output(), "code", {1, code_size(encoder)});
  return model.SerializeAsString();
}

}  // namespace samewhere::train
