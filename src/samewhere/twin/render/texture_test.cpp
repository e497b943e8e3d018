#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/twin/building/test_furniture.hpp>
#include <samewhere/twin/render/texture.hpp>

namespace samewhere::twin {
namespace {

using test::texture_of;

TEST(Texture, FadesWithDistanceToItsMean) {
  for (const Finish finish : {Finish::kWall, Finish::kCarpet, Finish::kCeiling, Finish::kWood,
                              Finish::kConcrete, Finish::kFloorTiles, Finish::kFabric}) {
    Rectangle r{.size_m = {4.0F, 2.6F}};
    r.material = {.finish = finish, .wear_seed = 11, .pattern_seed = 12};
    const auto deviation = [&](float footprint_m) {
      constexpr int kNumPoints = 400;
      Eigen::ArrayXf values(kNumPoints);
      for (int i = 0; i < kNumPoints; ++i) {
        const auto ratio = static_cast<float>(i) / kNumPoints;
        const TexturePoint point{1.0F + 2.1F * ratio, 0.2F + 0.6F * ratio, footprint_m};
        values[i] = reflectance(r, point).mean();
      }
      return std::sqrt((values - values.mean()).square().mean());
    };
    EXPECT_GT(deviation(0.001F), 1.5F * deviation(0.5F)) << static_cast<int>(finish);
    EXPECT_GT(deviation(0.001F), 0.01F) << static_cast<int>(finish);
  }
}

TEST(Texture, IsNeverBrighterThanLightNorDarkerThanNone) {
  for (int finish = 0; finish <= static_cast<int>(Finish::kBigNumber); ++finish) {
    Rectangle r{.size_m = {0.8F, 0.9F}};
    r.material = {.finish = static_cast<Finish>(finish),
                  .colour = Colour::Constant(0.5F),
                  .wear_seed = 3,
                  .pattern_seed = 4,
                  .own_pattern_seed = 5,
                  .own_ratio = 0.4F,
                  .number = 2,
                  .blot_seed = 9};
    const Eigen::ArrayXf values = texture_of(r, 0.001F);
    EXPECT_GE(values.minCoeff(), 0.0F) << finish;
    EXPECT_LT(values.maxCoeff(), 1.3F) << finish;
  }
}

}  // namespace
}  // namespace samewhere::twin
