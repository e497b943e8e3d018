#pragma once

// Parts of an ONNX model, as protocol-buffer messages (onnx.proto).

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include <onnx/onnx_pb.h>

namespace samewhere::train {

// A model without a graph.
onnx::ModelProto empty_model(int operator_set, const std::string& description);

// Stored numbers.
void add_tensor(onnx::GraphProto& graph, const std::string& name,
                std::span<const std::int64_t> shape, const std::vector<float>& numbers);
void add_shape_tensor(onnx::GraphProto& graph, const std::string& name,
                      const std::vector<std::int64_t>& numbers);

// Attributes of a node.
void add_sizes(onnx::NodeProto& node, const std::string& name,
               std::initializer_list<std::int64_t> sizes);
void add_number(onnx::NodeProto& node, const std::string& name, float number);
void add_whole_number(onnx::NodeProto& node, const std::string& name, std::int64_t number);

// An input or output of the graph.
void add_shape(onnx::ValueInfoProto& value, const std::string& name,
               std::initializer_list<std::int64_t> shape);

// Nodes are chained: each takes what the last one gave.
class Chain {
 public:
  Chain(onnx::GraphProto& graph, std::string first) : graph_(graph), last_(std::move(first)) {}

  const std::string& last() const { return last_; }

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

// x / sqrt(floor + the sum of the squares of all channels), position by position.
void add_response_norm(Chain& chain, const std::string& name, int num_channels, float floor);

}  // namespace samewhere::train
