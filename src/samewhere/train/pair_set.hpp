#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/train/pair_config.hpp>
#include <samewhere/verify/pair_view.hpp>

namespace samewhere::train {

// A registered pair, and what is known of it.
struct PairExample {
  cv::Mat planes;  // packed()
  bool is_same = false;
};

// How many pairs a source gave.
struct PairSource {
  std::string source;
  int num_same = 0;
  int num_wrong = 0;
  bool is_held_back = false;
};

// Pairs in the order of their sources.
struct PairSet {
  std::vector<PairExample> pairs;
  std::vector<PairSource> sources;
  std::string sha256;  // of the pairs
};

// Planes of a verify::PairView in 8 bits, and back: what was 0 and 1 is so again.
cv::Mat packed(const cv::Mat& planes);
cv::Mat unpacked(const cv::Mat& packed);

// The pairs of pairs::labelled_pairs() of each source that can be registered, those to validate
// with last. Throws InputError if a source cannot be read or says nothing about places, if it is to
// be learnt from and validated with, or if there are no pairs of one kind to learn from or to
// validate with. Throws core::Interrupted if it is interrupted.
PairSet read_pairs(std::span<const std::string> sources, std::span<const std::string> validate,
                   const PairConfig& config);

// Keeps the pairs in a file, under the name of what they were made of, so that they need not be
// made again; reads them. Throws InputError if the file cannot be written; is of other sources or
// settings; or is damaged.
void write_pairs(const std::filesystem::path& path, const PairSet& set, const std::string& made_of);
PairSet load_pairs(const std::filesystem::path& path, const std::string& made_of);

// Indices of the pairs to learn from, or of those to validate with.
std::vector<int> pairs_of(const PairSet& set, bool is_held_back);

}  // namespace samewhere::train
