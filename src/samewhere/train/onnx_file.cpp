#include <cstdint>
#include <span>

#include <samewhere/train/onnx_file.hpp>
#include <samewhere/train/onnx_graph.hpp>

namespace samewhere::train {
namespace {

constexpr int kOperatorSet = 11;

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

void add_nodes(onnx::GraphProto& graph, const Encoder& encoder) {
  Chain chain(graph, "image");
  const std::size_t num_convolutions = encoder.convolutions.size();
  for (std::size_t i = 0; i < num_convolutions; ++i) {
    const std::string number = std::to_string(i + 1);
    add_convolution(graph, chain, "convolution" + number, encoder.convolutions[i]);
    if (i + 1 == num_convolutions) break;
    chain.add("Relu", "relu" + number);
    if (i > 0) continue;
    add_pooling(chain, "AveragePool", "cells", kCellSide, kCellSide);
    add_response_norm(chain, "response", encoder.convolutions[i].plan.num_outputs, kResponseFloor);
  }
  add_pooling(chain, "AveragePool", "mean", kCodeWindow, kCodeStep);
  chain.add("Sigmoid", "bounded");
  add_whole_number(chain.add("Flatten", "code"), "axis", 1);
}

}  // namespace

std::string onnx_bytes(const Encoder& encoder, const std::string& description) {
  onnx::ModelProto model = empty_model(kOperatorSet, description);
  onnx::GraphProto& graph = *model.mutable_graph();
  graph.set_name("encoder");
  add_shape(*graph.add_input(), "image", {1, 1, encoder.input_px.height, encoder.input_px.width});
  add_nodes(graph, encoder);
  add_shape(*graph.add_output(), "code", {1, code_size(encoder)});
  return model.SerializeAsString();
}

}  // namespace samewhere::train
