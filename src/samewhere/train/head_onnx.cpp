#include <array>

#include <samewhere/train/head_onnx.hpp>
#include <samewhere/train/onnx_graph.hpp>

namespace samewhere::train {
namespace {

// From 13 on the softmax is over one axis.
constexpr int kHeadOperatorSet = 13;

void add_power(onnx::GraphProto& graph, Chain& chain, const std::string& name, float power) {
  add_tensor(graph, name + "_exponent", {}, {power});
  chain.add("Pow", name).add_input(name + "_exponent");
}

// One linear layer, the same at every position.
struct PositionLayer {
  int outputs = 0;
  int inputs = 0;
  const std::vector<float>& weights;  // outputs x inputs
  const std::vector<float>& biases;   // outputs
};

void add_position_layer(onnx::GraphProto& graph, Chain& chain, const std::string& name,
                        const PositionLayer& layer) {
  const std::array<std::int64_t, 4> shape{layer.outputs, layer.inputs, 1, 1};
  const std::array<std::int64_t, 1> length{layer.outputs};
  add_tensor(graph, name + "_weights", shape, layer.weights);
  add_tensor(graph, name + "_biases", length, layer.biases);
  onnx::NodeProto& node = chain.add("Conv", name);
  node.add_input(name + "_weights");
  node.add_input(name + "_biases");
  add_sizes(node, "kernel_shape", {1, 1});
}

void add_reshape(onnx::GraphProto& graph, Chain& chain, const std::string& name,
                 const std::vector<std::int64_t>& shape) {
  add_shape_tensor(graph, name + "_shape", shape);
  chain.add("Reshape", name).add_input(name + "_shape");
}

void add_transpose(Chain& chain, const std::string& name) {
  add_sizes(chain.add("Transpose", name), "perm", {1, 0});
}

// Per cluster the sum of its shares times its centre: reduced x clusters. A convolution of groups
// of one channel multiplies each cluster's mean share by its centre and the number of positions.
void add_shared_centres(onnx::GraphProto& graph, Chain& chain, const HeadWeights& head) {
  const auto num_positions = static_cast<float>(head.shape.rows * head.shape.columns);
  std::vector<float> centres = head.centres;
  for (float& number : centres) number *= num_positions;
  chain.add("GlobalAveragePool", "mean_share");
  const std::array<std::int64_t, 4> shape{std::int64_t{head.clusters} * head.reduced, 1, 1, 1};
  add_tensor(graph, "centre_weights", shape, centres);
  onnx::NodeProto& node = chain.add("Conv", "centre");
  node.add_input("centre_weights");
  add_sizes(node, "kernel_shape", {1, 1});
  add_whole_number(node, "group", head.clusters);
  add_reshape(graph, chain, "centre_rows", {head.clusters, head.reduced});
  add_transpose(chain, "shared_centres");
}

std::string add_vlad(onnx::GraphProto& graph, Chain& chain, const HeadWeights& head) {
  const std::int64_t num_positions = std::int64_t{head.shape.rows} * head.shape.columns;
  add_position_layer(graph, chain, "reduced",
                     {head.reduced, head.shape.channels, head.reduce_weights, head.reduce_biases});
  add_response_norm(chain, "local", head.reduced, kNetvladFloor);
  Chain shares(graph, "local");
  add_position_layer(graph, shares, "assigned",
                     {head.clusters, head.reduced, head.assign_weights, head.assign_biases});
  add_whole_number(shares.add("Softmax", "share"), "axis", 1);
  Chain centres(graph, "share");
  add_shared_centres(graph, centres, head);
  add_reshape(graph, shares, "share_rows", {head.clusters, num_positions});
  add_transpose(shares, "position_shares");
  add_reshape(graph, chain, "local_rows", {head.reduced, num_positions});
  chain.add("MatMul", "sums").add_input(shares.last());
  chain.add("Sub", "residuals").add_input(centres.last());
  add_reshape(graph, chain, "residual_map", {1, head.reduced, head.clusters, 1});
  add_response_norm(chain, "vlad", head.reduced, kNetvladFloor);
  return chain.last();
}

void add_pooling_of(onnx::GraphProto& graph, Chain& chain, const HeadWeights& head) {
  switch (head.kind) {
    case HeadKind::kGem:
      add_power(graph, chain, "raised", head.power);
      chain.add("GlobalAveragePool", "mean");
      add_power(graph, chain, "root", 1.0F / head.power);
      return;
    case HeadKind::kNetvlad:
      add_vlad(graph, chain, head);
      return;
    case HeadKind::kDarknet: {
      const int rows = head.shape.rows / kDarknetParts;
      const int columns = head.shape.columns / kDarknetParts;
      onnx::NodeProto& node = chain.add("AveragePool", "parts");
      add_sizes(node, "kernel_shape", {rows, columns});
      add_sizes(node, "strides", {rows, columns});
      return;
    }
  }
}

}  // namespace

std::string head_onnx_bytes(const HeadWeights& head) {
  onnx::ModelProto model = empty_model(kHeadOperatorSet, "feature map of a trunk to a vector");
  onnx::GraphProto& graph = *model.mutable_graph();
  graph.set_name("head");
  add_shape(*graph.add_input(), "features",
            {1, head.shape.channels, head.shape.rows, head.shape.columns});
  Chain chain(graph, "features");
  add_pooling_of(graph, chain, head);
  add_whole_number(chain.add("Flatten", "pooled"), "axis", 1);
  const auto length = static_cast<std::int64_t>(head.project_weights.size()) / head.code_size;
  const std::array<std::int64_t, 2> shape{head.code_size, length};
  const std::array<std::int64_t, 1> biases{head.code_size};
  add_tensor(graph, "project_weights", shape, head.project_weights);
  add_tensor(graph, "project_biases", biases, head.project_biases);
  onnx::NodeProto& node = chain.add("Gemm", "code");
  node.add_input("project_weights");
  node.add_input("project_biases");
  add_whole_number(node, "transB", 1);
  add_shape(*graph.add_output(), "code", {1, head.code_size});
  return model.SerializeAsString();
}

}  // namespace samewhere::train
