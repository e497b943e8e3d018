#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace samewhere::core {

// Seed of one message of one stage: the same whatever ran before it.
std::uint64_t seed_of(std::uint64_t config_seed, std::string_view stage, std::uint64_t message_id);

// Seeded generator (xoshiro256**, Blackman and Vigna 2018) with distributions of our own, because
// the standard library's differ between implementations.
class Random {
 public:
  explicit Random(std::uint64_t seed);

  std::uint64_t next();
  // Uniform in [0, bound); bound > 0.
  std::uint64_t index(std::uint64_t bound);
  // Uniform in [0, 1).
  double uniform();
  double uniform(double low, double high);
  // Normal with mean 0 and standard deviation 1 (Box and Muller 1958).
  double gaussian();
  // `count` different indices below `bound`, in the order drawn; count <= bound.
  std::vector<int> distinct_indices(int count, int bound);

 private:
  std::array<std::uint64_t, 4> state_;
};

}  // namespace samewhere::core
