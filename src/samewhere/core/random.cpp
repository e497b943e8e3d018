#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>

namespace samewhere::core {
namespace {

// splitmix64 (Steele, Lea and Flood 2014): spreads any seed over the whole word.
std::uint64_t mix(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

std::uint64_t seed_of(std::uint64_t config_seed, std::string_view stage, std::uint64_t message_id) {
  std::uint64_t state = config_seed;
  for (const char c : stage) state = mix(state) ^ static_cast<unsigned char>(c);
  state = mix(state) ^ message_id;
  return mix(state);
}

Random::Random(std::uint64_t seed) : state_{} {
  for (auto& word : state_) word = mix(seed);
}

std::uint64_t Random::next() {
  const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

std::uint64_t Random::index(std::uint64_t bound) {
  // not by require(): clang's analyzer follows the division below, and not into errors.cpp
  if (bound == 0)
    throw ContractError("promise broken: Random::index is asked for an index below at least 1");
  // draws at the ragged end of the range are thrown away, or small indices would come more often
  const std::uint64_t limit = ~std::uint64_t{0} - ~std::uint64_t{0} % bound;
  std::uint64_t drawn = next();
  while (drawn >= limit) drawn = next();
  return drawn % bound;
}

double Random::uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

double Random::gaussian() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

std::vector<int> Random::distinct_indices(int count, int bound) {
  require(count >= 0 && count <= bound, "Random::distinct_indices is asked for at most `bound`");
  std::vector<int> drawn;
  drawn.reserve(static_cast<std::size_t>(count));
  while (static_cast<int>(drawn.size()) < count) {
    const int candidate = static_cast<int>(index(static_cast<std::uint64_t>(bound)));
    if (std::find(drawn.begin(), drawn.end(), candidate) == drawn.end()) drawn.push_back(candidate);
  }
  return drawn;
}

}  // namespace samewhere::core
