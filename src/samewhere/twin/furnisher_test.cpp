#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/twin/furnisher.hpp>
#include <samewhere/twin/office_loop.hpp>
#include <samewhere/twin/texture.hpp>

namespace samewhere::twin {
namespace {

// Leaf and plate of every door, in the order of the rooms.
std::vector<Rectangle> faces_with(const std::vector<Rectangle>& rectangles, Finish finish,
                                  const Eigen::Vector2f& size_m) {
  std::vector<Rectangle> found;
  for (const auto& r : rectangles) {
    if (std::abs(r.normal().z()) > 0.5F || r.material.finish != finish) continue;
    if ((r.size_m - size_m).norm() < 1e-3F) found.push_back(r);
  }
  return found;
}

std::vector<Rectangle> door_leaves(const std::vector<Rectangle>& rectangles) {
  return faces_with(rectangles, Finish::kWood, {0.90F, 2.05F});
}

// Brightness of the texture on a grid, seen from close by.
Eigen::ArrayXf texture_of(const Rectangle& rectangle) {
  constexpr int kSide = 60;
  Eigen::ArrayXf values(kSide * kSide);
  const Eigen::Vector2f step_m = rectangle.size_m / kSide;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const TexturePoint point{(static_cast<float>(column) + 0.5F) * step_m.x(),
                               (static_cast<float>(row) + 0.5F) * step_m.y(), 0.004F};
      values[row * kSide + column] = reflectance(rectangle, point).mean();
    }
  }
  return values;
}

double correlation(const Eigen::ArrayXf& a, const Eigen::ArrayXf& b) {
  const Eigen::ArrayXf da = a - a.mean();
  const Eigen::ArrayXf db = b - b.mean();
  return (da * db).sum() / std::sqrt((da * da).sum() * (db * db).sum());
}

// How alike neighbouring doors are: mean correlation of their textures, largest colour difference.
struct Likeness {
  double texture = 0.0;
  double colour_difference = 0.0;
};

Likeness likeness_of_doors(double similarity) {
  const auto leaves = door_leaves(office_loop_surfaces(5, similarity));
  Likeness likeness;
  for (std::size_t i = 1; i < leaves.size(); ++i) {
    likeness.texture += correlation(texture_of(leaves[i - 1]), texture_of(leaves[i])) /
                        static_cast<double>(leaves.size() - 1);
    const Colour difference = (leaves[i].material.colour - leaves[i - 1].material.colour).abs();
    likeness.colour_difference =
        std::max(likeness.colour_difference, static_cast<double>(difference.maxCoeff()));
  }
  return likeness;
}

TEST(Doors, StandOnBothSidesOfTheWholeLoop) {
  EXPECT_EQ(door_leaves(office_loop_surfaces(5, 0.8)).size(), 30U);
}

TEST(Doors, AreAlikeButForWearAtSimilarityOne) {
  const Likeness likeness = likeness_of_doors(1.0);
  EXPECT_GT(likeness.texture, 0.5);
  EXPECT_LT(likeness.texture, 0.99) << "wear is never the same twice";
  EXPECT_EQ(likeness.colour_difference, 0.0);
}

TEST(Doors, HaveTheirOwnLooksAtSimilarityZero) {
  const Likeness likeness = likeness_of_doors(0.0);
  EXPECT_LT(likeness.texture, 0.2);
  EXPECT_GT(likeness.colour_difference, 0.2);
}

TEST(Doors, BecomeMoreAlikeAsSimilarityGrows) {
  const Likeness low = likeness_of_doors(0.3);
  const Likeness high = likeness_of_doors(0.8);
  EXPECT_LT(low.texture, high.texture);
  EXPECT_GT(low.colour_difference, high.colour_difference);
}

TEST(Doors, EachHasItsOwnNumber) {
  const auto plates = faces_with(office_loop_surfaces(5, 1.0), Finish::kPlate, {0.17F, 0.15F});
  ASSERT_EQ(plates.size(), 30U);
  for (std::size_t i = 1; i < plates.size(); ++i) {
    EXPECT_EQ(plates[i].material.number, plates[i - 1].material.number + 1);
    EXPECT_GT((texture_of(plates[i]) - texture_of(plates[i - 1])).abs().maxCoeff(), 0.2F);
  }
}

TEST(Posters, AreCopiesOfEachOtherAtSimilarityOneOnly) {
  const auto num_prints = [](double similarity) {
    std::vector<std::uint32_t> seeds;
    for (const auto& r : office_loop_surfaces(5, similarity)) {
      if (r.material.finish != Finish::kPaper) continue;
      if (r.size_m.minCoeff() > 0.1F) seeds.push_back(r.material.pattern_seed);
    }
    std::sort(seeds.begin(), seeds.end());
    const auto num_sheets = seeds.size();
    seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
    return std::pair(seeds.size(), num_sheets);
  };
  const auto [num_alike, num_sheets_alike] = num_prints(1.0);
  EXPECT_LE(num_alike, 11U);  // one for each slot on a board, poster, label
  EXPECT_GT(num_sheets_alike, 50U);
  const auto [num_own, num_sheets_own] = num_prints(0.0);
  EXPECT_EQ(num_own, num_sheets_own);
}

TEST(Texture, FadesWithDistanceToItsMean) {
  for (const Finish finish : {Finish::kWall, Finish::kCarpet, Finish::kCeiling, Finish::kWood}) {
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
    EXPECT_GT(deviation(0.001F), 2.0F * deviation(0.5F)) << static_cast<int>(finish);
    EXPECT_GT(deviation(0.001F), 0.01F) << static_cast<int>(finish);
  }
}

}  // namespace
}  // namespace samewhere::twin
