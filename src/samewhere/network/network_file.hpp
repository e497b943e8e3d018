#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace samewhere::network {

// An ONNX file that turns one picture, or the feature map of one, into one vector, and what it says
// of its ends.
struct NetworkFile {
  std::filesystem::path path;
  std::string bytes;
  std::uint64_t checksum = 0;  // of the bytes
  std::string input_name;
  std::string output_name;
  int num_channels = 1;  // of the input: 1 grey, 3 colour, or those of a feature map
  cv::Size input_px;
};

// The file that a setting names, as core::find_model() finds it. Throws InputError naming the
// setting and both places if it is in neither.
std::filesystem::path find_network(const std::string& setting, const std::string& file);

// Reads the file and the description of its ends. Throws InputError naming the file, what it holds
// and what was expected: if it is no ONNX file or cut short, or unless it has one input of floats
// 1xCxHxW (C, H, W fixed; the first dimension may be free) and one output of floats.
NetworkFile read_network(const std::filesystem::path& path);
// The same of bytes that need not be in the file yet: `path` is what complaints name.
NetworkFile parse_network(const std::filesystem::path& path, std::string bytes);

// The input as the backends take it: continuous, four dimensions, 1xCxHxW. `input`: that, or for
// one channel rows x columns; 32-bit floats of the network's size, else ContractError.
cv::Mat as_blob(const cv::Mat& input, const NetworkFile& network);

// Throws InputError naming the network and the shape unless that is 1xN.
void require_row(const NetworkFile& network, const std::vector<std::int64_t>& output_shape);

}  // namespace samewhere::network
