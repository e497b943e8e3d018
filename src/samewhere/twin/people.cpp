#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/twin/people.hpp>

namespace samewhere::twin {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRightOfPath_m = 0.42;
constexpr double kSmoothing_m = 0.45;  // half the stretch over which corners are rounded
constexpr double kStride_m = 1.45;     // two steps

// A joint of the body: x to the left, y forwards, z up for who stands upright.
using Joint = Eigen::Isometry3f;

Joint moved(const Joint& from, float left_m, float forward_m, float up_m) {
  return from * Eigen::Translation3f(left_m, forward_m, up_m);
}

// What hangs from the joint swings forwards.
Joint swung(const Joint& from, float angle_rad) {
  return from * Eigen::AngleAxisf(angle_rad, Eigen::Vector3f::UnitX());
}

// An upright prism below or above a joint.
struct Prism {
  Eigen::Vector2f size_m = Eigen::Vector2f::Ones();  // across and along
  float low_m = 0.0F;
  float high_m = 1.0F;
  int num_sides = 6;
  bool has_top = false;
};

// Points of the path moved to the right of whoever walks along them.
std::vector<Eigen::Vector3d> right_side(const std::vector<Eigen::Vector3d>& points_m) {
  std::vector<Eigen::Vector3d> moved_m;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3d& before = points_m[i > 0 ? i - 1 : 0];
    const Eigen::Vector3d& after = points_m[std::min(i + 1, points_m.size() - 1)];
    const Eigen::Vector2d along = (after - before).head<2>().normalized();
    moved_m.push_back(points_m[i] + kRightOfPath_m * Eigen::Vector3d(along.y(), -along.x(), 0.0));
  }
  return moved_m;
}

Colour any_colour(core::Random& random, double darkest, double brightest) {
  const double value = random.uniform(darkest, brightest);
  const auto channel = [&] { return static_cast<float>(value * random.uniform(0.55, 1.0)); };
  const float red = channel();
  const float green = channel();
  return colour_of_srgb(red, green, channel());
}

// Black, brown, fair or grey.
Colour hair_colour(core::Random& random) {
  const auto value = static_cast<float>(random.uniform(0.1, 0.5));
  const auto warmth = static_cast<float>(random.uniform(0.0, 0.45));
  return colour_of_srgb(value, (1.0F - 0.6F * warmth) * value, (1.0F - warmth) * value);
}

Material cloth(core::Random& random, Finish finish, const Colour& colour) {
  return {.finish = finish,
          .colour = colour,
          .second = any_colour(random, 0.2, 0.9),
          .wear_seed = static_cast<std::uint32_t>(random.next()),
          .pattern_seed = static_cast<std::uint32_t>(random.next())};
}

}  // namespace

// Collects the surfaces of a body.
class Person::Figure {
 public:
  explicit Figure(const Looks& looks) : looks_(looks) {}

  std::vector<Rectangle> build(const Joint& world_from_feet, double phase_rad) {
    const float h = looks_.height_ratio;
    const auto swing = static_cast<float>(std::sin(phase_rad));
    const float bob_m = 0.02F * static_cast<float>(std::cos(2.0 * phase_rad));
    const Joint hips = moved(world_from_feet, 0.0F, 0.0F, 0.90F * h + bob_m);
    add_trunk(hips, 0.03F * swing);
    for (const float side : {-1.0F, 1.0F}) {
      add_leg(moved(hips, 0.10F * side, 0.0F, 0.0F), phase_rad + (side > 0.0F ? 0.0 : kPi));
      add_arm(moved(hips, 0.20F * side * looks_.width_ratio, 0.0F, 0.455F * h), -side * swing,
              side);
    }
    return std::move(rectangles_);
  }

 private:
  void add(const Joint& joint, const Prism& prism, const Material& material) {
    for (int i = 0; i < prism.num_sides; ++i) {
      add_side(joint, prism, i, material);
    }
    if (!prism.has_top) return;
    const Eigen::Vector2f size = 0.75F * prism.size_m;
    rectangles_.push_back(
        {.corner_m = joint * Eigen::Vector3f(-0.5F * size.x(), -0.5F * size.y(), prism.high_m),
         .right = joint.linear().col(0),
         .up = joint.linear().col(1),
         .size_m = size,
         .material = material});
  }

  // Corners of the prism lie on an ellipse; the pattern runs on around it.
  void add_side(const Joint& joint, const Prism& prism, int side, const Material& material) {
    const auto corner = [&](int i) {
      const float angle_rad = static_cast<float>(kPi) * (2.0F * static_cast<float>(i) - 1.0F) /
                              static_cast<float>(prism.num_sides);
      return joint * Eigen::Vector3f(0.5F * prism.size_m.x() * std::cos(angle_rad),
                                     0.5F * prism.size_m.y() * std::sin(angle_rad), prism.low_m);
    };
    const Eigen::Vector3f first = corner(side);
    const Eigen::Vector3f across = corner(side + 1) - first;
    const float width_m = across.norm();
    rectangles_.push_back({.corner_m = first,
                           .right = across / width_m,
                           .up = joint.linear().col(2),
                           .size_m = {width_m, prism.high_m - prism.low_m},
                           .pattern_m = {width_m * static_cast<float>(side), prism.low_m},
                           .material = material});
  }

  void add_trunk(const Joint& hips, float turn_rad) {
    const float h = looks_.height_ratio;
    const float w = looks_.width_ratio;
    const Joint chest = hips * Eigen::AngleAxisf(turn_rad, Eigen::Vector3f::UnitZ());
    add(hips, {{0.33F * w, 0.23F * w}, -0.10F, 0.06F, 8, false}, looks_.trousers);
    add(chest, {{0.35F * w, 0.24F * w}, -0.02F, 0.30F * h, 8, false}, looks_.top);
    add(chest, {{0.38F * w, 0.24F * w}, 0.25F * h, 0.44F * h, 8, false}, looks_.top);
    add(chest, {{0.35F * w, 0.21F * w}, 0.43F * h, 0.475F * h, 8, false}, looks_.top);
    add(chest, {{0.29F * w, 0.17F * w}, 0.46F * h, 0.50F * h, 8, false}, looks_.top);
    add(chest, {{0.19F * w, 0.14F * w}, 0.49F * h, 0.52F * h, 8, true}, looks_.top);
    add_head(moved(hips, 0.0F, 0.02F, 0.54F * h));
  }

  void add_head(const Joint& neck) {
    add(neck, {{0.11F, 0.12F}, -0.05F, 0.08F, 8, false}, looks_.skin);
    const Joint face = moved(neck, 0.0F, 0.02F, 0.0F);
    add(face, {{0.115F, 0.15F}, 0.03F, 0.08F, 8, false}, looks_.skin);
    add(face, {{0.145F, 0.185F}, 0.07F, 0.21F, 8, false}, looks_.skin);
    const Joint hair = moved(neck, 0.0F, -0.005F, 0.0F);
    add(hair, {{0.155F, 0.175F}, 0.11F, 0.22F, 8, false}, looks_.hair);
    add(moved(hair, 0.0F, 0.02F, 0.0F), {{0.15F, 0.19F}, 0.19F, 0.24F, 8, true}, looks_.hair);
    add(moved(hair, 0.0F, 0.01F, 0.0F), {{0.11F, 0.15F}, 0.23F, 0.265F, 8, true}, looks_.hair);
  }

  // The thigh swings, the knee gives way while the leg comes forwards.
  void add_leg(const Joint& hip, double phase_rad) {
    const float h = looks_.height_ratio;
    const auto lift = static_cast<float>(std::max(0.0, std::cos(phase_rad)));
    const Joint thigh = swung(hip, 0.42F * static_cast<float>(std::sin(phase_rad)) + 0.12F * lift);
    const Joint knee = moved(thigh, 0.0F, 0.0F, -0.44F * h);
    const Joint shin = swung(knee, -0.15F - 0.75F * lift);
    add(thigh, {{0.16F, 0.18F}, -0.46F * h, 0.0F, 8, false}, looks_.trousers);
    add(shin, {{0.12F, 0.13F}, -0.40F * h, 0.04F, 8, false}, looks_.trousers);
    const Joint foot = swung(moved(shin, 0.0F, 0.06F, -0.46F * h), 0.1F + 0.3F * lift);
    add(foot, {{0.11F, 0.32F}, 0.0F, 0.08F, 4, true}, looks_.shoes);
  }

  void add_arm(const Joint& shoulder, float swing, float side) {
    const float h = looks_.height_ratio;
    const Joint upper =
        swung(shoulder, 0.38F * swing) * Eigen::AngleAxisf(-0.08F * side, Eigen::Vector3f::UnitY());
    const Joint fore = swung(moved(upper, 0.0F, 0.0F, -0.29F * h), 0.30F + 0.15F * swing);
    add(upper, {{0.11F, 0.115F}, -0.31F * h, 0.02F, 8, true}, looks_.top);
    add(fore, {{0.085F, 0.09F}, -0.25F * h, 0.02F, 8, false}, looks_.top);
    add(fore, {{0.06F, 0.09F}, -0.40F * h, -0.25F * h, 5, false}, looks_.skin);
  }

  const Looks& looks_;
  std::vector<Rectangle> rectangles_;
};

Person::Person(const std::vector<Eigen::Vector3d>& path_m, std::uint64_t seed) {
  core::require(path_m.size() >= 2, "a person's path has two points or more");
  const std::vector<Eigen::Vector3d> back_m(path_m.rbegin(), path_m.rend());
  round_m_ = right_side(path_m);
  const std::vector<Eigen::Vector3d> returning_m = right_side(back_m);
  round_m_.insert(round_m_.end(), returning_m.begin(), returning_m.end());
  round_m_.push_back(round_m_.front());
  reached_m_.push_back(0.0);
  for (std::size_t i = 1; i < round_m_.size(); ++i) {
    reached_m_.push_back(reached_m_.back() + (round_m_[i] - round_m_[i - 1]).norm());
  }
  core::Random random(core::seed_of(seed, "twin.person", 0));
  speed_m_s_ = random.uniform(0.95, 1.35);
  start_m_ = random.uniform(0.0, reached_m_.back());
  constexpr std::array<Finish, 3> kTops = {Finish::kPaint, Finish::kCarpet, Finish::kGrille};
  const auto skin = static_cast<float>(random.uniform(0.35, 0.9));
  looks_ = {.skin = cloth(random, Finish::kPaint, colour_of_srgb(skin, 0.8F * skin, 0.68F * skin)),
            .hair = cloth(random, Finish::kPaint, hair_colour(random)),
            .top = cloth(random, kTops[random.index(kTops.size())], any_colour(random, 0.3, 0.95)),
            .trousers = cloth(random, Finish::kPaint, any_colour(random, 0.15, 0.45)),
            .shoes = cloth(random, Finish::kPaint, any_colour(random, 0.1, 0.4)),
            .height_ratio = static_cast<float>(random.uniform(0.92, 1.08)),
            .width_ratio = static_cast<float>(random.uniform(0.92, 1.12))};
}

// At a distance of any size along the round.
Eigen::Vector3d Person::point(double distance_m) const {
  const double total_m = reached_m_.back();
  const double on_round_m = distance_m - total_m * std::floor(distance_m / total_m);
  const auto next = std::upper_bound(reached_m_.begin() + 1, reached_m_.end() - 1, on_round_m);
  const auto i = static_cast<std::size_t>(next - reached_m_.begin());
  const double length_m = reached_m_[i] - reached_m_[i - 1];
  const double ratio = length_m > 0.0 ? (on_round_m - reached_m_[i - 1]) / length_m : 0.0;
  return round_m_[i - 1] + ratio * (round_m_[i] - round_m_[i - 1]);
}

// A mean over a stretch: corners and ends are walked as bends.
Eigen::Vector3d Person::smooth_point(double distance_m) const {
  constexpr int kHalfSamples = 6;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = -kHalfSamples; i <= kHalfSamples; ++i) {
    sum += point(distance_m + kSmoothing_m * i / kHalfSamples);
  }
  return sum / (2 * kHalfSamples + 1);
}

Eigen::Vector3d Person::position_m(double stamp_s) const {
  return smooth_point(distance_m(stamp_s));
}

std::vector<Rectangle> Person::at(double stamp_s) const {
  constexpr double kHeadingReach_m = 0.15;
  const double walked_m = distance_m(stamp_s);
  const Eigen::Vector3d ahead =
      smooth_point(walked_m + kHeadingReach_m) - smooth_point(walked_m - kHeadingReach_m);
  const auto heading_rad = static_cast<float>(std::atan2(ahead.y(), ahead.x()));
  Joint world_from_feet = Joint::Identity();
  world_from_feet.translation() = smooth_point(walked_m).cast<float>();
  // y of the body is forwards
  world_from_feet.rotate(
      Eigen::AngleAxisf(heading_rad - 0.5F * static_cast<float>(kPi), Eigen::Vector3f::UnitZ()));
  return Figure(looks_).build(world_from_feet, 2.0 * kPi * walked_m / kStride_m);
}

std::vector<Person> people_on(const std::vector<std::vector<Eigen::Vector3d>>& paths_m, int count,
                              std::uint64_t seed) {
  core::require(count == 0 || !paths_m.empty(), "people need a path to walk along");
  std::vector<Person> people;
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    people.emplace_back(paths_m[index % paths_m.size()], core::seed_of(seed, "twin.people", index));
  }
  return people;
}

std::vector<Rectangle> rectangles_of(const std::vector<Person>& people, double stamp_s) {
  std::vector<Rectangle> all;
  for (const auto& person : people) {
    const std::vector<Rectangle> one = person.at(stamp_s);
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

}  // namespace samewhere::twin
