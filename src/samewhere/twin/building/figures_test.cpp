#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/twin/building/figures.hpp>

namespace samewhere::twin {
namespace {

Eigen::AlignedBox3f box_of(const std::vector<Rectangle>& rectangles) {
  Eigen::AlignedBox3f box;
  for (const auto& r : rectangles) {
    for (const Eigen::Vector2f& corner : {Eigen::Vector2f(0.0F, 0.0F), Eigen::Vector2f(1.0F, 0.0F),
                                          Eigen::Vector2f(0.0F, 1.0F), Eigen::Vector2f(1.0F, 1.0F)})
      box.extend(r.at(corner.cwiseProduct(r.size_m)));
  }
  return box;
}

TEST(Figures, StandOnTheFloorAndAreAsTallAsPeople) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Look look = look_of(seed);
    for (float phase = 0.0F; phase < 1.0F; phase += 0.1F) {
      const auto box = box_of(figure(look, phase, {3.0F, -2.0F, 1.5F}, 0.7F));
      EXPECT_NEAR(box.min().z(), 1.5F, 0.03F) << "seed " << seed << " phase " << phase;
      EXPECT_NEAR(box.sizes().z(), look.height_m, 0.12F) << "seed " << seed;
      EXPECT_LT(box.sizes().head<2>().maxCoeff(), 1.4F);
    }
  }
}

TEST(Figures, HaveSidesOfUnitLengthAtRightAngles) {
  for (const auto& r : figure(look_of(3), 0.3F, Eigen::Vector3f::Zero(), 2.0F)) {
    EXPECT_NEAR(r.right.norm(), 1.0F, 1e-5F);
    EXPECT_NEAR(r.up.norm(), 1.0F, 1e-5F);
    EXPECT_NEAR(r.right.dot(r.up), 0.0F, 1e-5F);
  }
}

TEST(Figures, LookOutwards) {
  // the flux of the position through a surface that looks outwards is three times its volume; the
  // parts overlap and have no undersides, so it is roughly that
  float volume_m3 = 0.0F;
  for (const auto& r : figure(look_of(5), 0.1F, Eigen::Vector3f::Zero(), 0.0F)) {
    volume_m3 += r.size_m.prod() * r.normal().dot(r.at(0.5F * r.size_m)) / 3.0F;
  }
  EXPECT_GT(volume_m3, 0.1F);
  EXPECT_LT(volume_m3, 0.6F);
}

TEST(Figures, SwingLegsInTurn) {
  const Look look = look_of(8);
  const auto at = [&](float phase) { return figure(look, phase, Eigen::Vector3f::Zero(), 0.0F); };
  EXPECT_EQ(at(0.0F).size(), at(0.37F).size());
  const auto reach = [&](float phase) { return box_of(at(phase)).sizes().x(); };
  EXPECT_GT(reach(0.25F), reach(0.0F) + 0.1F);  // feet wide apart, then side by side
  EXPECT_NEAR(reach(0.25F), reach(0.75F), 0.05F);
  EXPECT_GT(stride_m(look), 1.0F);
  EXPECT_LT(stride_m(look), 1.6F);
}

TEST(Figures, WearTheirOwnClothes) {
  EXPECT_NE(look_of(1).jacket.pattern_seed, look_of(2).jacket.pattern_seed);
  EXPECT_EQ(look_of(1).jacket.pattern_seed, look_of(1).jacket.pattern_seed);
}

}  // namespace
}  // namespace samewhere::twin
