#pragma once

// Makes small ONNX files for tests, byte by byte, as protocol-buffer messages (onnx.proto).

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include <samewhere/core/random.hpp>

namespace samewhere::network::test {

inline std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7) bytes += static_cast<char>(value | 0x80);
  return bytes + static_cast<char>(value);
}

inline std::string number(int id, std::uint64_t value) {
  return varint(static_cast<std::uint64_t>(id) << 3) + varint(value);
}

inline std::string bytes(int id, const std::string& content) {
  return varint((static_cast<std::uint64_t>(id) << 3) | 2) + varint(content.size()) + content;
}

using Shape = std::vector<int>;  // a negative size is free

inline std::string end_of_graph(const std::string& name, const Shape& shape, int element) {
  std::string dimensions;
  for (const int size : shape) {
    dimensions +=
        bytes(1, size < 0 ? bytes(2, "free") : number(1, static_cast<std::uint64_t>(size)));
  }
  const std::string tensor = number(1, static_cast<std::uint64_t>(element)) + bytes(2, dimensions);
  return bytes(1, name) + bytes(2, bytes(1, tensor));
}

inline std::string weights(const std::string& name, const Shape& shape,
                           const std::vector<float>& values) {
  std::string tensor;
  for (const int size : shape) tensor += number(1, static_cast<std::uint64_t>(size));
  std::string raw(values.size() * sizeof(float), '\0');
  std::memcpy(raw.data(), values.data(), raw.size());
  return tensor + number(2, 1) + bytes(8, name) + bytes(9, raw);
}

inline std::string node(const std::string& op, std::initializer_list<std::string> inputs,
                        const std::string& output, const std::string& attributes = "") {
  std::string message;
  for (const std::string& input : inputs) message += bytes(1, input);
  return message + bytes(2, output) + bytes(3, op + "_" + output) + bytes(4, op) + attributes;
}

inline std::string numbers_attribute(const std::string& name, std::initializer_list<int> values) {
  std::string message = bytes(1, name);
  for (const int value : values) message += number(8, static_cast<std::uint64_t>(value));
  return bytes(5, message + number(20, 7));
}

inline std::string number_attribute(const std::string& name, int value) {
  return bytes(5, bytes(1, name) + number(3, static_cast<std::uint64_t>(value)) + number(20, 2));
}

// Convolution (8 of 5x5, step 2), rectifier, and a layer that connects all to the code.
struct TestNetwork {
  Shape input{1, 1, 24, 32};
  int element = 1;         // 1: float, 7: int64
  int code_length = 16;    // 0: without the last layer
  float bias = 0.0F;       // of the code
  std::uint64_t seed = 1;  // of the weights
  bool has_second_output = false;
  bool has_node_behind_code = false;  // whose output the file does not declare
};

inline std::vector<float> random_weights(core::Random& random, int count, double size) {
  std::vector<float> values(static_cast<std::size_t>(count));
  for (float& value : values) value = static_cast<float>(size * random.gaussian());
  return values;
}

// The file. Sizes of the layers are those of the network's last two input sizes.
inline std::string onnx_file(const TestNetwork& network) {
  constexpr int kChannels = 8;
  constexpr int kKernel = 5;
  core::Random random(network.seed);
  const int num_features =
      kChannels * ((network.input[2] - kKernel) / 2 + 1) * ((network.input[3] - kKernel) / 2 + 1);
  const Shape kernel{kChannels, network.input[1], kKernel, kKernel};
  const int kernel_size = kChannels * network.input[1] * kKernel * kKernel;
  std::string graph =
      bytes(1, node("Conv", {"image", "kernel"}, "edges",
                    numbers_attribute("kernel_shape", {kKernel, kKernel}) +
                        numbers_attribute("strides", {2, 2}))) +
      bytes(1, node("Relu", {"edges"}, network.code_length > 0 ? "features" : "code"));
  if (network.code_length > 0) {
    graph +=
        bytes(1, node("Flatten", {"features"}, "row", number_attribute("axis", 1))) +
        bytes(1, node("Gemm", {"row", "matrix", "bias"}, "code", number_attribute("transB", 1)));
  }
  if (network.has_node_behind_code) graph += bytes(1, node("Sigmoid", {"code"}, "behind"));
  graph += bytes(2, "test") +
           bytes(5, weights("kernel", kernel, random_weights(random, kernel_size, 0.2)));
  if (network.code_length > 0) {
    const std::vector<float> bias(static_cast<std::size_t>(network.code_length), network.bias);
    graph += bytes(5, weights("matrix", {network.code_length, num_features},
                              random_weights(random, network.code_length * num_features, 0.05))) +
             bytes(5, weights("bias", {network.code_length}, bias));
  }
  graph += bytes(11, end_of_graph("image", network.input, network.element)) +
           bytes(12, end_of_graph("code", {1, network.code_length}, 1));
  if (network.has_second_output) graph += bytes(12, end_of_graph("row", {1, num_features}, 1));
  return number(1, 6) + bytes(2, "samewhere test") + bytes(7, graph) +
         bytes(8, bytes(1, "") + number(2, 11));
}

}  // namespace samewhere::network::test
