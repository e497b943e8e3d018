#include <array>

#include <samewhere/twin/print.hpp>

namespace samewhere::twin {
namespace {

// Digits of 3 x 5 dots, the upper row in the highest bits.
constexpr std::array<std::uint16_t, 10> kDigits = {
    0b111'101'101'101'111, 0b010'110'010'010'111, 0b111'001'111'100'111, 0b111'001'111'001'111,
    0b101'101'111'001'001, 0b111'100'111'001'111, 0b111'100'111'101'111, 0b111'001'001'001'001,
    0b111'101'111'101'111, 0b111'101'111'001'111};

Colour mixed(const Colour& under, const Colour& over, float coverage) {
  return under + coverage * (over - under);
}

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

float number_ink(int number, const TexturePoint& p, float dot_m) {
  float ink = 0.0F;
  int rest = number;
  for (int place = 2; place >= 0; --place) {
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
  const float dot_m = 0.06F * size_m.x();
  const TexturePoint in_number{p.u_m - 0.1F * size_m.x(), p.v_m - 0.58F * size_m.y(),
                               p.footprint_m};
  const float number = visible_share(dot_m, p.footprint_m) * number_ink(m.number, in_number, dot_m);
  const Eigen::Vector2f margin_m = 0.1F * size_m;
  const float names = in_frame(p, margin_m, {size_m.x() - margin_m.x(), 0.5F * size_m.y()}) *
                      text_ink(p, 0.14F * size_m.y(), m.wear_seed);
  return mixed(m.colour, m.second, std::max(number, 0.85F * names));
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
  return colour * (1.0F + creases);
}

Colour pictogram(const Rectangle& sign, const TexturePoint& p) {
  const Material& m = sign.material;
  const Eigen::Vector2f size_m = sign.size_m;
  const Eigen::Vector2f border_m = 0.06F * size_m;
  const float frame = 1.0F - in_frame(p, border_m, size_m - border_m);
  // an arrow head on the right, bars on the left
  const float from_middle_m = std::abs(p.v_m - 0.5F * size_m.y());
  const float along_m = p.u_m - 0.58F * size_m.x();
  const float head = beyond(along_m, p.footprint_m) *
                     beyond(0.3F * size_m.y() - along_m - from_middle_m, p.footprint_m);
  const Eigen::Vector2f bar_low_m(0.15F * size_m.x(), 0.25F * size_m.y());
  const Eigen::Vector2f bar_high_m(0.28F * size_m.x(), 0.75F * size_m.y());
  const float bar = in_frame(p, bar_low_m, bar_high_m);
  const Eigen::Vector2f shift_m(0.2F * size_m.x(), 0.0F);
  const float second_bar = in_frame(p, bar_low_m + shift_m, bar_high_m + 0.7F * shift_m);
  return mixed(m.colour, m.second, std::max({frame, head, bar, second_bar}));
}

}  // namespace samewhere::twin
