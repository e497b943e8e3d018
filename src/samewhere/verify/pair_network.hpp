#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <samewhere/network/inference.hpp>
#include <samewhere/verify/pair_view.hpp>

namespace samewhere::verify {

// A trained network that looks at a registered pair (`samewhere train pairs`; after Doppelgangers,
// Cai et al., ICCV 2023).
class PairNetwork {
 public:
  // `file`: an ONNX network that makes one number of the planes of a PairView, looked for as
  // network::find_network() does under the name `setting`. Throws InputError naming the file if it
  // is not there, cannot be run, or is another network.
  PairNetwork(const std::string& setting, const std::string& file);

  // How probable it is that both views show the same place, in [0, 1]. As probable as the pairs it
  // was trained on, half of which are of one place: a measure, not a forecast. Throws InputError if
  // the network gives no finite number.
  double probability_of_same(const PairView& pair);

  std::uint64_t checksum() const { return checksum_; }

 private:
  explicit PairNetwork(const network::NetworkFile& file);

  std::filesystem::path path_;
  std::uint64_t checksum_ = 0;
  std::unique_ptr<network::Inference> inference_;
};

}  // namespace samewhere::verify
