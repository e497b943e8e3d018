#include <cmath>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/building/figures.hpp>
#include <samewhere/twin/building/shapes.hpp>

namespace samewhere::twin {
namespace {

constexpr float kUsualHeight_m = 1.75F;

Colour dye(core::Random& random) {
  const Colour dyes[] = {colour_of_srgb(0.16F, 0.18F, 0.24F), colour_of_srgb(0.30F, 0.32F, 0.36F),
                         colour_of_srgb(0.45F, 0.18F, 0.18F), colour_of_srgb(0.20F, 0.32F, 0.46F),
                         colour_of_srgb(0.30F, 0.38F, 0.26F), colour_of_srgb(0.70F, 0.66F, 0.58F),
                         colour_of_srgb(0.58F, 0.46F, 0.30F), colour_of_srgb(0.82F, 0.82F, 0.80F)};
  return dyes[random.index(std::size(dyes))] * static_cast<float>(random.uniform(0.8, 1.2));
}

Material cloth(core::Random& random) {
  constexpr int kNumKinds = 3;
  const Colour colour = dye(random);
  const Colour second = dye(random);
  const auto seed = static_cast<std::uint32_t>(random.next());
  return {.finish = Finish::kFabric,
          .colour = colour,
          .second = second,
          .wear_seed = seed + 1,
          .pattern_seed = seed,
          .own_pattern_seed = seed,
          .number = static_cast<int>(random.index(kNumKinds))};
}

Material plain(Finish finish, const Colour& colour, core::Random& random) {
  const auto seed = static_cast<std::uint32_t>(random.next());
  return {.finish = finish,
          .colour = colour,
          .second = colour,
          .wear_seed = seed + 1,
          .pattern_seed = seed,
          .own_pattern_seed = seed};
}

// A body in the making: x to its left, as seen from the front the right, y up, z forward; metres
// of a person of the usual height.
class Body {
 public:
  Body(const Look& look, Shapes& shapes)
      : look_(look), shapes_(shapes), scale_(look.height_m / kUsualHeight_m) {}

  // Round, thinner or thicker towards its end.
  struct Part {
    Eigen::Vector3f from_m;
    Eigen::Vector3f to_m;
    Eigen::Vector2f radii_m;  // of its first and of its second half
  };
  void add_part(const Part& part, const Material& material) {
    const Eigen::Vector3f middle_m = 0.5F * (part.from_m + part.to_m);
    add_bar(part.from_m, middle_m, part.radii_m.x(), material);
    add_bar(middle_m, part.to_m, part.radii_m.y(), material);
  }
  void add_block(const Eigen::Vector3f& low_m, const Eigen::Vector3f& high_m,
                 const Material& material) {
    shapes_.add_block({scale_ * low_m, scale_ * high_m}, material);
  }
  // In metres of a person of the usual height.
  void add_post(Post post, const Material& material) {
    post.low_m *= scale_;
    post.high_m *= scale_;
    post.middle_m *= scale_;
    post.half_m *= scale_;
    shapes_.add_post(post, material);
  }
  const Look& look() const { return look_; }

 private:
  // Patterns and light run on around it: it has as many sides as it takes to look round.
  void add_bar(const Eigen::Vector3f& from_m, const Eigen::Vector3f& to_m, float radius_m,
               const Material& material) {
    constexpr int kNumSides = 8;
    shapes_.add_bar({.from_m = scale_ * from_m,
                     .to_m = scale_ * to_m,
                     .radius_m = scale_ * look_.girth * radius_m,
                     .num_sides = kNumSides},
                    material);
  }

  const Look& look_;
  Shapes& shapes_;
  float scale_;
};

// Where a limb of two straight parts ends that hangs from a joint: angles forward from straight
// down, of the upper and of the lower part.
struct Limb {
  Eigen::Vector3f joint_m;
  Eigen::Vector3f middle_m;
  Eigen::Vector3f end_m;
};

Eigen::Vector3f hanging(float angle_rad, float length_m) {
  return {0.0F, -length_m * std::cos(angle_rad), length_m * std::sin(angle_rad)};
}

Limb limb_from(const Eigen::Vector3f& joint_m, const Eigen::Vector2f& lengths_m, float upper_rad,
               float lower_rad) {
  const Eigen::Vector3f middle_m = joint_m + hanging(upper_rad, lengths_m.x());
  return {joint_m, middle_m, middle_m + hanging(lower_rad, lengths_m.y())};
}

constexpr float kHip_m = 0.90F;
constexpr float kThigh_m = 0.43F;
constexpr float kShin_m = 0.41F;
constexpr float kSwing_rad = 0.42F;

// The hip swings the thigh; the knee bends while the leg comes forward.
Limb leg_at(float side, float cycle_rad) {
  const float thigh_rad = kSwing_rad * std::sin(cycle_rad);
  const float bend_rad = 0.12F + 0.85F * std::pow(std::max(0.0F, std::cos(cycle_rad)), 2.0F);
  return limb_from({side * 0.095F, kHip_m, 0.0F}, {kThigh_m, kShin_m}, thigh_rad,
                   thigh_rad - bend_rad);
}

void add_leg(Body& body, float side, float cycle_rad, float lift_m) {
  const Look& look = body.look();
  Limb leg = leg_at(side, cycle_rad);
  for (Eigen::Vector3f* point : {&leg.joint_m, &leg.middle_m, &leg.end_m}) point->y() += lift_m;
  const float thigh_m = look.has_skirt ? 0.065F : 0.085F;
  body.add_part({leg.middle_m, leg.joint_m, {0.85F * thigh_m, thigh_m}}, look.trousers);
  body.add_part({leg.end_m, leg.middle_m, {0.05F, 0.062F}},
                look.has_skirt ? look.skin : look.trousers);
  const Eigen::Vector3f heel_m = leg.end_m + Eigen::Vector3f(-0.045F, -0.06F, -0.07F);
  body.add_block(heel_m, heel_m + Eigen::Vector3f(0.09F, 0.085F, 0.26F), look.shoes);
}

void add_arm(Body& body, float side, float cycle_rad, float lift_m) {
  const Look& look = body.look();
  const float upper_rad = 0.35F * std::sin(cycle_rad);
  const Limb arm =
      limb_from({side * 0.2F, 1.39F + lift_m, 0.0F}, {0.28F, 0.25F}, upper_rad, upper_rad + 0.3F);
  const Eigen::Vector3f out(side * 0.035F, 0.0F, 0.0F);
  body.add_part({arm.middle_m + out, arm.joint_m, {0.047F, 0.055F}}, look.jacket);
  body.add_part({arm.end_m + out, arm.middle_m + out, {0.036F, 0.043F}}, look.jacket);
  const Eigen::Vector3f hand_m = arm.end_m + out;
  body.add_part({hand_m + Eigen::Vector3f(0.0F, -0.15F, 0.03F), hand_m, {0.027F, 0.031F}},
                look.skin);
  // the round of the shoulder
  const float wide = look.girth;
  const auto add = [&](float low_m, float high_m, float radius_m) {
    body.add_post({.low_m = low_m + lift_m,
                   .high_m = high_m + lift_m,
                   .middle_m = {side * 0.2F, 0.0F},
                   .half_m = Eigen::Vector2f::Constant(radius_m * wide),
                   .num_sides = 8,
                   .has_lid = true},
                  look.jacket);
  };
  add(1.37F, 1.41F, 0.058F);
  add(1.41F, 1.432F, 0.043F);
}

// A slice of a trunk or a head: around (0, y, z).
struct Slice {
  float low_m;
  float high_m;
  Eigen::Vector2f half_m;
  float z_m = 0.0F;
  bool has_lid = true;
};

void add_slice(Body& body, const Slice& slice, float lift_m, const Material& material) {
  body.add_post({.low_m = slice.low_m + lift_m,
                 .high_m = slice.high_m + lift_m,
                 .middle_m = {0.0F, slice.z_m},
                 .half_m = slice.half_m,
                 .has_lid = slice.has_lid},
                material);
}

void add_trunk(Body& body, float lift_m) {
  const Look& look = body.look();
  const float wide = look.girth;
  add_slice(body, {kHip_m - 0.06F, 0.97F, {0.165F * wide, 0.115F * wide}, 0.0F, false}, lift_m,
            look.trousers);
  const Slice jacket[] = {{0.94F, 1.08F, {0.17F * wide, 0.12F * wide}},
                          {1.08F, 1.2F, {0.168F * wide, 0.117F * wide}, 0.0F, false},
                          {1.2F, 1.3F, {0.177F * wide, 0.122F * wide}, 0.0F, false},
                          {1.3F, 1.39F, {0.185F * wide, 0.12F * wide}},
                          {1.39F, 1.425F, {0.17F, 0.105F}},
                          {1.425F, 1.45F, {0.135F, 0.088F}},
                          {1.45F, 1.47F, {0.095F, 0.072F}}};
  for (const auto& slice : jacket) add_slice(body, slice, lift_m, look.jacket);
  if (look.has_skirt) {
    add_slice(body, {0.74F, 0.96F, {0.185F * wide, 0.14F * wide}}, lift_m, look.trousers);
    add_slice(body, {0.55F, 0.74F, {0.195F * wide, 0.165F * wide}}, lift_m, look.trousers);
  }
  if (!look.has_bag) return;
  body.add_block({-0.15F, 1.02F + lift_m, -0.27F}, {0.15F, 1.40F + lift_m, -0.11F * wide},
                 look.bag);
}

void add_head(Body& body, float lift_m) {
  const Look& look = body.look();
  const Slice skin[] = {{1.44F, 1.56F, {0.055F, 0.058F}, 0.0F, false},
                        {1.525F, 1.545F, {0.045F, 0.055F}, 0.03F, false},
                        {1.545F, 1.58F, {0.062F, 0.078F}, 0.018F},
                        {1.58F, 1.62F, {0.07F, 0.09F}, 0.013F},
                        {1.62F, 1.69F, {0.075F, 0.095F}, 0.011F, false}};
  for (const auto& slice : skin) add_slice(body, slice, lift_m, look.skin);
  const float hem_m = look.has_long_hair ? 1.42F : 1.57F;
  const Slice hair[] = {{hem_m, 1.69F, {0.078F, 0.06F}, -0.038F, false},
                        {1.68F, 1.708F, {0.081F, 0.101F}, 0.004F},
                        {1.708F, 1.732F, {0.072F, 0.09F}, 0.0F},
                        {1.732F, 1.75F, {0.05F, 0.065F}, 0.0F}};
  for (const auto& slice : hair) add_slice(body, slice, lift_m, look.hair);
  // a nose tells the front
  const Eigen::Vector3f up(0.0F, lift_m, 0.0F);
  body.add_block(up + Eigen::Vector3f(-0.012F, 1.6F, 0.09F),
                 up + Eigen::Vector3f(0.012F, 1.635F, 0.121F), look.skin);
}

}  // namespace

Look look_of(std::uint64_t seed) {
  core::Random random(core::seed_of(seed, "twin.look", 0));
  Look look;
  look.height_m = static_cast<float>(random.uniform(1.58, 1.92));
  look.girth = static_cast<float>(random.uniform(0.9, 1.2));
  look.has_skirt = random.uniform() < 0.2;
  look.has_long_hair = random.uniform() < 0.4;
  look.has_bag = random.uniform() < 0.35;
  look.jacket = cloth(random);
  look.trousers = cloth(random);
  look.trousers.number = 0;
  const Colour skins[] = {colour_of_srgb(0.87F, 0.68F, 0.57F), colour_of_srgb(0.76F, 0.56F, 0.43F),
                          colour_of_srgb(0.55F, 0.38F, 0.28F), colour_of_srgb(0.36F, 0.25F, 0.19F)};
  look.skin = plain(Finish::kSkin, skins[random.index(std::size(skins))], random);
  const Colour hairs[] = {colour_of_srgb(0.10F, 0.08F, 0.07F), colour_of_srgb(0.30F, 0.20F, 0.13F),
                          colour_of_srgb(0.66F, 0.52F, 0.33F), colour_of_srgb(0.60F, 0.58F, 0.56F)};
  look.hair = plain(Finish::kHair, hairs[random.index(std::size(hairs))], random);
  look.shoes = plain(Finish::kPlastic, 0.5F * dye(random), random);
  look.bag = cloth(random);
  return look;
}

float stride_m(const Look& look) {
  const float leg_m = (kThigh_m + kShin_m) * look.height_m / kUsualHeight_m;
  return 4.0F * leg_m * std::sin(kSwing_rad) * 0.95F;
}

std::vector<Rectangle> figure(const Look& look, float phase, const Eigen::Vector3f& position_m,
                              float heading_rad) {
  constexpr float kSole_m = 0.06F;  // the foot's joint above the floor
  const Eigen::Vector3f front(std::cos(heading_rad), std::sin(heading_rad), 0.0F);
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  std::vector<Rectangle> rectangles;
  Shapes shapes(rectangles, stand_of(position_m, up.cross(front), up));
  Body body(look, shapes);
  const float cycle_rad = 2.0F * kPi_f * phase;
  // the lower foot stands on the floor
  const float lowest_m =
      std::min(leg_at(-1.0F, cycle_rad).end_m.y(), leg_at(1.0F, cycle_rad + kPi_f).end_m.y());
  const float lift_m = kSole_m - lowest_m;
  add_trunk(body, lift_m);
  add_head(body, lift_m);
  for (const float side : {-1.0F, 1.0F}) {
    const float leg_rad = side < 0.0F ? cycle_rad : cycle_rad + kPi_f;
    add_leg(body, side, leg_rad, lift_m);
    add_arm(body, side, leg_rad + kPi_f, lift_m);
  }
  return rectangles;
}

}  // namespace samewhere::twin
