#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/similarity.hpp>

namespace samewhere::core {
namespace {

// Deviations below this share of the vector's own size are rounding, not structure.
constexpr double kMinRelativeDeviation = 1e-6;

void require_same_length(std::span<const float> x, std::span<const float> y) {
  require(x.size() == y.size(), "only vectors of one length are compared");
}

double sum_of_squares(std::span<const float> x) {
  double sum = 0.0;
  for (const float value : x) sum += static_cast<double>(value) * value;
  return sum;
}

// x_i - mean(x), eq. (8)-(9); all zero for a constant vector.
std::vector<double> deviations(std::span<const float> x) {
  std::vector<double> deviation(x.begin(), x.end());
  double mean = 0.0;
  for (const double value : deviation) mean += value;
  mean /= static_cast<double>(std::max<std::size_t>(x.size(), 1));
  double sum_squared = 0.0;
  for (double& value : deviation) {
    value -= mean;
    sum_squared += value * value;
  }
  const double smallest = kMinRelativeDeviation * kMinRelativeDeviation * sum_of_squares(x);
  if (sum_squared <= smallest) std::fill(deviation.begin(), deviation.end(), 0.0);
  return deviation;
}

}  // namespace

float dot(std::span<const float> x, std::span<const float> y) {
  require_same_length(x, y);
  // sixteen partial sums that do not depend on each other: the compiler turns them into vector
  // registers without being allowed to reorder additions
  constexpr std::size_t kNumLanes = 16;
  std::array<float, kNumLanes> partial{};
  const std::size_t whole = x.size() - x.size() % kNumLanes;
  for (std::size_t i = 0; i < whole; i += kNumLanes) {
    for (std::size_t lane = 0; lane < kNumLanes; ++lane) {
      partial[lane] += x[i + lane] * y[i + lane];
    }
  }
  for (std::size_t i = whole; i < x.size(); ++i) partial[i - whole] += x[i] * y[i];
  for (std::size_t width = kNumLanes / 2; width > 0; width /= 2) {
    for (std::size_t lane = 0; lane < width; ++lane) partial[lane] += partial[lane + width];
  }
  return partial[0];
}

double cosine(std::span<const float> x, std::span<const float> y) {
  require_same_length(x, y);
  double product = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) product += static_cast<double>(x[i]) * y[i];
  const double lengths = std::sqrt(sum_of_squares(x)) * std::sqrt(sum_of_squares(y));
  return lengths > 0.0 ? std::clamp(product / lengths, -1.0, 1.0) : 0.0;  // eq. (7)
}

double ncc(std::span<const float> x, std::span<const float> y) {
  require_same_length(x, y);
  const std::vector<double> dx = deviations(x);
  const std::vector<double> dy = deviations(y);
  double covariance = 0.0;
  double variance_x = 0.0;
  double variance_y = 0.0;
  for (std::size_t i = 0; i < dx.size(); ++i) {
    covariance += dx[i] * dy[i];
    variance_x += dx[i] * dx[i];
    variance_y += dy[i] * dy[i];
  }
  const double scale = std::sqrt(variance_x) * std::sqrt(variance_y);
  return scale > 0.0 ? std::clamp(covariance / scale, -1.0, 1.0) : 0.0;  // eq. (13)
}

std::vector<float> centred_unit(std::span<const float> x) {
  const std::vector<double> deviation = deviations(x);
  const std::vector<float> centred(deviation.begin(), deviation.end());
  return unit(centred);
}

float inverse_deviation(std::span<const float> x) {
  double sum_squared = 0.0;
  for (const double deviation : deviations(x)) sum_squared += deviation * deviation;
  return sum_squared > 0.0 ? static_cast<float>(1.0 / std::sqrt(sum_squared)) : 0.0F;
}

std::vector<float> unit(std::span<const float> x) {
  const double length = std::sqrt(sum_of_squares(x));
  std::vector<float> scaled(x.size(), 0.0F);
  if (length <= 0.0) return scaled;
  for (std::size_t i = 0; i < x.size(); ++i) scaled[i] = static_cast<float>(x[i] / length);
  return scaled;
}

bool is_unit_or_zero(std::span<const float> x) {
  constexpr double kTolerance = 1e-3;
  const double squared_length = sum_of_squares(x);
  return squared_length == 0.0 || std::abs(squared_length - 1.0) < kTolerance;  // false on NaN
}

}  // namespace samewhere::core
