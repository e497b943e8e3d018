#include <array>
#include <cmath>

#include <samewhere/twin/render/finishes.hpp>
#include <samewhere/twin/render/print.hpp>

namespace samewhere::twin {
namespace {

// Digits of 3 x 5 dots, the upper row in the highest bits.
constexpr std::array<std::uint16_t, 10> kDigits = {
    0b111'101'101'101'111, 0b010'110'010'010'111, 0b111'001'111'100'111, 0b111'001'111'001'111,
    0b101'101'111'001'001, 0b111'100'111'001'111, 0b111'100'111'101'111, 0b111'001'001'001'001,
    0b111'101'111'101'111, 0b111'101'111'001'111};

float in_frame(const TexturePoint& p, const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m) {
  return inside(p.u_m, low_m.x(), high_m.x(), p.footprint_m) *
         inside(p.v_m, low_m.y(), high_m.y(), p.footprint_m);
}

// Ink of a digit whose lower left corner is the origin, `dot_m` being the size of a dot.
float digit_ink(int digit, const TexturePoint& p, float dot_m) {
  const int column = floor_int(p.u_m / dot_m);
  const int row = floor_int(p.v_m / dot_m);  // counted from below
  if (column < 0 || column > 2 || row < 0 || row > 4) return 0.0F;
  const int bit = 3 * row + (2 - column);
  return static_cast<float>((kDigits[static_cast<std::size_t>(digit)] >> bit) & 1U);
}

int num_digits(int number) {
  int count = 1;
  for (int rest = number / 10; rest > 0; rest /= 10) ++count;
  return count;
}

// Its lower left corner is the origin; digits are four dots apart.
float number_ink(int number, const TexturePoint& p, float dot_m) {
  float ink = 0.0F;
  int rest = number;
  for (int place = num_digits(number) - 1; place >= 0; --place) {
    TexturePoint in_digit = p;
    in_digit.u_m -= 4.0F * dot_m * static_cast<float>(place);
    ink += digit_ink(rest % 10, in_digit, dot_m);
    rest /= 10;
  }
  return ink;
}

// Lines of words: rows at a pitch, words of random length, letters as upright strokes.
float text_ink(const TexturePoint& p, float pitch_m, std::uint32_t seed) {
  constexpr float kMeanInk = 0.22F;
  const float rows = p.v_m / pitch_m;
  const int row = floor_int(rows);
  const float in_row = rows - static_cast<float>(row);
  const float share = visible_share(0.6F * pitch_m, p.footprint_m);
  if (share <= 0.0F) return kMeanInk;
  const float line = inside(in_row, 0.22F, 0.68F, p.footprint_m / pitch_m);
  const float word_m = 2.2F * pitch_m;
  const int word = floor_int(p.u_m / word_m + 0.37F * static_cast<float>(row & 3));
  const bool is_blank = (hash_cell(word, row, seed) & 7U) == 0U;
  const float glyphs =
      mosaic({p.u_m, 0.5F * pitch_m + pitch_m * static_cast<float>(row), p.footprint_m},
             0.28F * pitch_m, pitch_m, seed + 1);
  const float letters = clamp01(0.55F + 1.3F * glyphs);
  return lerp(kMeanInk, is_blank ? 0.0F : line * letters, share);
}

// How a poster is laid out, all from one seed.
struct Layout {
  explicit Layout(std::uint32_t seed)
      : heading_ratio(0.12F + 0.12F * unit_float(scramble(seed + 1))),
        picture_low_ratio(0.15F + 0.3F * unit_float(scramble(seed + 2))),
        picture_high_ratio(picture_low_ratio + 0.2F + 0.2F * unit_float(scramble(seed + 3))),
        pitch_ratio(0.022F + 0.02F * unit_float(scramble(seed + 4))),
        picture_seed(scramble(seed + 5)) {}

  float heading_ratio;  // of the height
  float picture_low_ratio;
  float picture_high_ratio;
  float pitch_ratio;  // of the lines of text
  std::uint32_t picture_seed;
};

// Somewhat greyed: pure inks scream.
Colour print_colour(std::uint32_t seed) {
  const Colour ink = {unit_float(scramble(seed)), unit_float(scramble(seed + 1)),
                      unit_float(scramble(seed + 2))};
  return (0.65F * ink + 0.35F * ink.mean()).square();
}

Colour picture(const TexturePoint& p, const Eigen::Vector2f& size_m, std::uint32_t seed) {
  const float scale_m = 0.22F * size_m.x();
  const float shapes = mosaic(p, scale_m, 0.7F * scale_m, seed);
  const float soft =
      octave_noise(p, {.wavelength_m = 0.8F * scale_m, .count = 5, .gain = 0.65F}, seed + 1);
  const float balls = spots(p, {.cell_m = 0.9F * scale_m, .density = 0.7F}, seed + 7);
  const Colour first = print_colour(seed + 11);
  const Colour second = print_colour(seed + 14);
  const Colour ground = mixed(first, second, clamp01(0.5F + 0.5F * shapes + 0.4F * soft));
  return mixed(ground, Colour::Constant(0.7F), 0.8F * balls);
}

}  // namespace

Colour door_plate(const Rectangle& plate, const TexturePoint& p) {
  const Material& m = plate.material;
  const Eigen::Vector2f size_m = plate.size_m;
  constexpr int kMostDigits = 3;
  const int num_dots = 4 * std::max(num_digits(m.number), kMostDigits) - 1;
  const float dot_m = 0.66F * size_m.x() / static_cast<float>(num_dots);
  const TexturePoint in_number{p.u_m - 0.1F * size_m.x(), p.v_m - 0.58F * size_m.y(),
                               p.footprint_m};
  const float number = visible_share(dot_m, p.footprint_m) * number_ink(m.number, in_number, dot_m);
  const Eigen::Vector2f margin_m = 0.1F * size_m;
  const float names = in_frame(p, margin_m, {size_m.x() - margin_m.x(), 0.5F * size_m.y()}) *
                      text_ink(p, 0.14F * size_m.y(), m.wear_seed);
  return mixed(m.colour, m.second, std::max(number, 0.85F * names)) * marked(p, m, 0.2F);
}

Colour poster(const Rectangle& paper, const TexturePoint& p) {
  const Material& m = paper.material;
  const Eigen::Vector2f size_m = paper.size_m;
  const Layout layout(m.pattern_seed);
  const float height_m = size_m.y();
  const Eigen::Vector2f margin_m = Eigen::Vector2f::Constant(0.07F * size_m.x());
  const float heading_low_m = height_m * (1.0F - layout.heading_ratio);
  const float heading = beyond(p.v_m - heading_low_m, p.footprint_m);
  const float print = in_frame(p, margin_m, size_m - margin_m);
  const float ink = print * text_ink(p, layout.pitch_ratio * height_m, m.pattern_seed);
  const float title =
      print * heading * text_ink(p, 0.6F * layout.heading_ratio * height_m, m.pattern_seed + 3);

  Colour colour = mixed(m.colour, Colour::Constant(0.03F), 0.9F * ink);
  const float in_picture =
      in_frame(p, {margin_m.x(), layout.picture_low_ratio * height_m},
               {size_m.x() - margin_m.x(), layout.picture_high_ratio * height_m});
  if (in_picture > 0.0F)
    colour = mixed(colour, picture(p, size_m, layout.picture_seed), in_picture);
  colour = mixed(colour, mixed(m.second, m.colour, title), heading);
  const float creases =
      0.05F * octave_noise(p, {.wavelength_m = 0.2F, .count = 3, .gain = 0.6F}, m.wear_seed);
  return colour * ((1.0F + creases) * marked(p, m, 0.15F));
}

namespace {

// A point of a sign: 0 to 1 from its lower left corner, with the size of a pixel.
struct SignPoint {
  float x = 0.0F;
  float y = 0.0F;
  float pixel = 0.0F;
};

float in_block(const SignPoint& p, const Eigen::Vector2f& low, const Eigen::Vector2f& high) {
  return inside(p.x, low.x(), high.x(), p.pixel) * inside(p.y, low.y(), high.y(), p.pixel);
}

// With its tip up or down, `half` its height and half its width.
float in_triangle(const SignPoint& p, const Eigen::Vector2f& middle, float half) {
  const float x = std::abs(p.x - middle.x());
  const float from_tip = (half > 0.0F ? middle.y() + half - p.y : p.y - middle.y() - half);
  const float size = std::abs(half);
  return beyond(0.5F * from_tip - x, p.pixel) * beyond(2.0F * size - from_tip, p.pixel);
}

// An arrow head on the right, bars on the left.
float arrow_ink(const SignPoint& p) {
  const SignPoint turned{p.y, p.x, p.pixel};
  return std::max({in_triangle(turned, {0.5F, 0.7F}, 0.2F),
                   in_block(p, {0.15F, 0.25F}, {0.25F, 0.75F}),
                   in_block(p, {0.32F, 0.3F}, {0.42F, 0.7F})});
}

float stairs_ink(const SignPoint& p) {
  constexpr float kStep = 0.15F;
  const float x = p.x - 0.18F;
  const float top = 0.2F + kStep * static_cast<float>(floor_int(x / kStep) + 1);
  return in_block(p, {0.18F, 0.2F}, {0.78F, 0.8F}) * beyond(top - p.y, p.pixel);
}

float lift_ink(const SignPoint& p) {
  const float frame =
      in_block(p, {0.2F, 0.15F}, {0.8F, 0.85F}) - in_block(p, {0.25F, 0.2F}, {0.75F, 0.8F});
  return std::max(
      {frame, in_triangle(p, {0.5F, 0.62F}, 0.1F), in_triangle(p, {0.5F, 0.38F}, -0.1F)});
}

float person_ink(const SignPoint& p) {
  const float from_head = std::hypot(p.x - 0.5F, p.y - 0.78F);
  return std::max({beyond(0.08F - from_head, p.pixel), in_block(p, {0.36F, 0.42F}, {0.64F, 0.67F}),
                   in_block(p, {0.40F, 0.14F}, {0.485F, 0.42F}),
                   in_block(p, {0.515F, 0.14F}, {0.60F, 0.42F})});
}

float extinguisher_ink(const SignPoint& p) {
  return std::max(
      {in_block(p, {0.36F, 0.15F}, {0.6F, 0.62F}), in_block(p, {0.43F, 0.62F}, {0.53F, 0.76F}),
       in_block(p, {0.40F, 0.76F}, {0.70F, 0.82F}), in_block(p, {0.66F, 0.45F}, {0.72F, 0.78F})});
}

float pictogram_ink(int number, const SignPoint& p) {
  switch (number) {
    case 1:
      return stairs_ink(p);
    case 2:
      return lift_ink(p);
    case 3:
      return person_ink(p);
    case 4:
      return extinguisher_ink(p);
    default:
      return arrow_ink(p);
  }
}

}  // namespace

Colour pictogram(const Rectangle& sign, const TexturePoint& p) {
  const Material& m = sign.material;
  const Eigen::Vector2f size_m = sign.size_m;
  const float least_m = size_m.minCoeff();
  const Eigen::Vector2f border_m = Eigen::Vector2f::Constant(0.05F * least_m);
  const float frame = 1.0F - in_frame(p, border_m, size_m - border_m);
  // a square in the middle of long signs
  const Eigen::Vector2f from_middle_m = Eigen::Vector2f(p.u_m, p.v_m) - 0.5F * size_m;
  const SignPoint at{from_middle_m.x() / least_m + 0.5F, from_middle_m.y() / least_m + 0.5F,
                     p.footprint_m / least_m};
  const float ink = pictogram_ink(m.number, at);
  return mixed(m.colour, m.second, std::max(frame, ink)) * marked(p, m, 0.2F);
}

Colour label(const Rectangle& paper, const TexturePoint& p) {
  const Material& m = paper.material;
  const Grain grain = grain_of(m);
  const Eigen::Vector2f size_m = paper.size_m;
  const Eigen::Vector2f margin_m = 0.08F * size_m;
  const float bars =
      clamp01(0.5F + 4.0F * mosaic(p, 0.0022F, 1.0F, grain)) * visible_share(0.002F, p.footprint_m);
  const float code_low_m = 0.5F * size_m.y();
  const float code = in_frame(p, {margin_m.x(), code_low_m}, size_m - margin_m) *
                     lerp(0.5F, bars, visible_share(0.0022F, p.footprint_m));
  const float text = in_frame(p, margin_m, {size_m.x() - margin_m.x(), 0.92F * code_low_m}) *
                     text_ink(p, 0.15F * size_m.y(), m.pattern_seed);
  const float band = beyond(p.v_m - 0.94F * size_m.y(), p.footprint_m);
  const Colour printed = mixed(m.colour, Colour::Constant(0.02F), 0.9F * std::max(code, text));
  return mixed(printed, m.second, band) * marked(p, m, 0.3F);
}

Colour big_number(const Rectangle& sign, const TexturePoint& p) {
  constexpr float kDotsHigh = 7.0F;
  const Material& m = sign.material;
  const float dot_m = sign.size_m.y() / kDotsHigh;
  const auto num_dots = static_cast<float>(4 * num_digits(m.number) - 1);
  const TexturePoint in_number{p.u_m - 0.5F * (sign.size_m.x() - num_dots * dot_m), p.v_m - dot_m,
                               p.footprint_m};
  return mixed(m.colour, m.second, number_ink(m.number, in_number, dot_m)) * marked(p, m, 0.25F);
}

}  // namespace samewhere::twin
