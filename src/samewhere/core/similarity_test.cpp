#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>

namespace samewhere::core {
namespace {

constexpr int kNumTrials = 100;

std::vector<float> random_values(Random& random, std::size_t size) {
  std::vector<float> vector(size);
  for (float& value : vector) value = static_cast<float>(random.gaussian());
  return vector;
}

std::vector<float> scaled(const std::vector<float>& x, float contrast, float brightness) {
  std::vector<float> y;
  for (const float value : x) y.push_back(contrast * value + brightness);
  return y;
}

TEST(Similarity, KnowsHandMadeCases) {
  const std::vector<float> x{1.0F, 2.0F, 3.0F};
  const std::vector<float> y{3.0F, 2.0F, 1.0F};
  EXPECT_NEAR(ncc(x, x), 1.0, 1e-12);
  EXPECT_NEAR(ncc(x, y), -1.0, 1e-12);
  EXPECT_NEAR(ncc(x, std::vector<float>{1.0F, 0.0F, 1.0F}), 0.0, 1e-12);
  EXPECT_NEAR(cosine(x, y), 10.0 / 14.0, 1e-12);
  EXPECT_EQ(dot(x, y), 10.0F);
}

TEST(Similarity, IsSymmetricAndStaysInsideMinusOneToOne) {
  for (int seed = 0; seed < kNumTrials; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const std::size_t size = 1 + random.index(60);
    const auto x = random_values(random, size);
    const auto y = random_values(random, size);
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const auto measure : {ncc, cosine}) {
      EXPECT_EQ(measure(x, y), measure(y, x));
      EXPECT_LE(std::abs(measure(x, y)), 1.0);
      EXPECT_LE(measure(x, x), 1.0);
    }
    EXPECT_EQ(dot(x, y), dot(y, x));
  }
}

TEST(Similarity, NccIgnoresBrightnessAndContrastAndCosineOnlyContrast) {
  for (int seed = 0; seed < kNumTrials; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const auto x = random_values(random, 50);
    const auto y = random_values(random, 50);
    const auto brighter = scaled(y, 1.0F, static_cast<float>(random.uniform(0.5, 2.0)));
    const auto stronger = scaled(y, static_cast<float>(random.uniform(0.1, 10.0)), 0.0F);
    const auto negative = scaled(y, -1.0F, 0.0F);
    SCOPED_TRACE("seed " + std::to_string(seed));
    EXPECT_NEAR(ncc(x, brighter), ncc(x, y), 1e-6);
    EXPECT_NEAR(ncc(x, stronger), ncc(x, y), 1e-6);
    EXPECT_NEAR(ncc(x, negative), -ncc(x, y), 1e-12);
    EXPECT_NEAR(cosine(x, stronger), cosine(x, y), 1e-6);
    EXPECT_GT(std::abs(cosine(y, brighter) - 1.0), 1e-3);
  }
}

TEST(Similarity, ABlackOrConstantViewCorrelatesWithNothing) {
  Random random(3);
  const auto x = random_values(random, 40);
  const std::vector<float> black(40, 0.0F);
  const std::vector<float> flat(40, 0.1F);  // 0.1 has no exact float, its mean is off by rounding
  EXPECT_EQ(ncc(x, black), 0.0);
  EXPECT_EQ(ncc(x, flat), 0.0);
  EXPECT_EQ(ncc(flat, flat), 0.0);
  EXPECT_EQ(cosine(x, black), 0.0);
  EXPECT_EQ(centred_unit(flat), black);
  EXPECT_EQ(unit(black), black);
  EXPECT_EQ(ncc({}, {}), 0.0);
}

TEST(Similarity, DotOfCentredUnitVectorsIsTheNcc) {
  for (int seed = 0; seed < kNumTrials; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const std::size_t size = 2 + random.index(2000);
    const auto x = scaled(random_values(random, size), 1.0F, 2.0F);
    const auto y = scaled(random_values(random, size), 3.0F, -1.0F);
    EXPECT_NEAR(dot(centred_unit(x), centred_unit(y)), ncc(x, y), 2e-6) << "seed " << seed;
    EXPECT_NEAR(dot(unit(x), unit(y)), cosine(x, y), 2e-6) << "seed " << seed;
    EXPECT_NEAR(dot(centred_unit(x), centred_unit(x)), 1.0, 2e-6) << "seed " << seed;
  }
}

TEST(Similarity, TheNccNeedsOnlyOneOfTheVectorsCentred) {
  for (int seed = 0; seed < kNumTrials; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const std::size_t size = 2 + random.index(60);
    const auto x = random_values(random, size);
    const auto y = unit(scaled(random_values(random, size), 1.0F, 2.0F));
    EXPECT_NEAR(dot(centred_unit(x), y) * inverse_deviation(y), ncc(x, y), 1e-5) << "seed " << seed;
  }
  EXPECT_EQ(inverse_deviation(std::vector<float>{3.0F, 3.0F, 3.0F}), 0.0F);
  EXPECT_EQ(inverse_deviation(std::vector<float>{0.0F, 0.0F}), 0.0F);
  EXPECT_FLOAT_EQ(inverse_deviation(std::vector<float>{1.0F, 4.0F, 1.0F, 4.0F}), 1.0F / 3.0F);
}

TEST(Similarity, UnitLengthIsMeasuredAndNotANumberHasNone) {
  EXPECT_TRUE(is_unit_or_zero(std::vector<float>{0.6F, -0.8F}));
  EXPECT_TRUE(is_unit_or_zero(std::vector<float>{0.0F, 0.0F}));
  EXPECT_FALSE(is_unit_or_zero(std::vector<float>{0.6F, 0.7F}));
  EXPECT_FALSE(is_unit_or_zero(std::vector<float>{1e-3F, 0.0F}));
  EXPECT_FALSE(is_unit_or_zero(std::vector<float>{std::numeric_limits<float>::quiet_NaN(), 1.0F}));
}

TEST(Similarity, DotAddsEveryElementOfEveryLength) {
  for (std::size_t size = 0; size < 70; ++size) {
    std::vector<float> x;
    for (std::size_t i = 0; i < size; ++i) x.push_back(static_cast<float>(i + 1));
    const std::vector<float> ones(size, 1.0F);
    const std::size_t sum = size * (size + 1) / 2;
    EXPECT_EQ(dot(x, ones), static_cast<float>(sum)) << "size " << size;
  }
}

TEST(Similarity, VectorsOfTwoLengthsAreNotCompared) {
  const std::vector<float> x(3, 1.0F);
  const std::vector<float> y(4, 1.0F);
  EXPECT_THROW(dot(x, y), ContractError);
  EXPECT_THROW(cosine(x, y), ContractError);
  EXPECT_THROW(ncc(x, y), ContractError);
}

}  // namespace
}  // namespace samewhere::core
