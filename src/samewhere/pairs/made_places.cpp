#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/pairs/made_places.hpp>

namespace samewhere::pairs {
namespace {

constexpr std::string_view kPrefix = "photos:";
const cv::Size kCanvas_px(420, 315);
constexpr double kMinOwnShare = 0.25;
constexpr double kMaxOwnShare = 0.75;
constexpr double kMaxFeather_px = 4.0;  // of the canvas
constexpr int kMaxPassing = 3;
constexpr double kMinPassingSide = 0.06;  // of the canvas
constexpr double kMaxPassingSide = 0.22;
constexpr double kMaxBend = 0.012;  // of the width
constexpr double kMinViewSide = 0.6;
constexpr double kMaxViewSide = 0.95;
constexpr double kMaxViewShift = 0.12;
constexpr double kMaxViewTurn_rad = 8.0 * std::numbers::pi / 180.0;
constexpr double kMaxCornerShift = 0.05;

// Numbers around 0 that change slowly over the canvas.
cv::Mat smooth_field(const cv::Size& knots, const cv::Size& size_px, core::Random& random) {
  cv::Mat coarse(knots, CV_32F);
  for (int row = 0; row < coarse.rows; ++row)
    for (int column = 0; column < coarse.cols; ++column)
      coarse.at<float>(row, column) = static_cast<float>(random.gaussian());
  cv::Mat fine;
  cv::resize(coarse, fine, size_px, 0.0, 0.0, cv::INTER_CUBIC);
  return fine;
}

// 1 where the field is highest, `share` of it.
cv::Mat highest(const cv::Mat& field, double share) {
  std::vector<float> values(field.begin<float>(), field.end<float>());
  const auto bar = values.begin() + static_cast<std::ptrdiff_t>(
                                        (1.0 - share) * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), bar, values.end());
  cv::Mat mask;
  cv::threshold(field, mask, *bar, 1.0, cv::THRESH_BINARY);
  return mask;
}

cv::Mat panels(double share, core::Random& random) {
  cv::Mat mask(kCanvas_px, CV_32F, cv::Scalar(0));
  while (cv::mean(mask)[0] < share) {
    const auto side = [&](int of_px) {
      return static_cast<int>(random.uniform(0.08, 0.35) * of_px);
    };
    const cv::Size size(side(kCanvas_px.width), side(kCanvas_px.height));
    const auto bound = [](int pixels) { return static_cast<std::uint64_t>(pixels); };
    const cv::Point corner(static_cast<int>(random.index(bound(kCanvas_px.width - size.width))),
                           static_cast<int>(random.index(bound(kCanvas_px.height - size.height))));
    mask(cv::Rect(corner, size)) = 1.0F;
  }
  return mask;
}

// Far from some point near the middle.
cv::Mat surroundings(double share, core::Random& random) {
  const double x_px = kCanvas_px.width * random.uniform(0.35, 0.65);
  const double y_px = kCanvas_px.height * random.uniform(0.35, 0.65);
  cv::Mat distance(kCanvas_px, CV_32F);
  for (int row = 0; row < distance.rows; ++row) {
    for (int column = 0; column < distance.cols; ++column)
      distance.at<float>(row, column) =
          static_cast<float>(std::hypot(column - x_px, 1.3 * (row - y_px)));
  }
  return highest(distance, share);
}

// Where either place has a look of its own, in [0, 1].
cv::Mat own_part(core::Random& random) {
  const double share = random.uniform(kMinOwnShare, kMaxOwnShare);
  cv::Mat mask;
  switch (random.index(3)) {
    case 0:
      mask = highest(smooth_field({5, 4}, kCanvas_px, random), share);
      break;
    case 1:
      mask = panels(share, random);
      break;
    default:
      mask = surroundings(share, random);
  }
  const double feather_px = random.uniform(0.0, kMaxFeather_px);
  if (feather_px > 0.3) cv::GaussianBlur(mask, mask, {0, 0}, feather_px);
  return mask;
}

cv::Mat on_canvas(const cv::Mat& picture) {
  core::require(picture.type() == CV_8UC1 && !picture.empty(), "a photo here is 8-bit grey");
  cv::Mat canvas;
  cv::resize(picture, canvas, kCanvas_px, 0.0, 0.0, cv::INTER_AREA);
  canvas.convertTo(canvas, CV_32F);
  return canvas;
}

// As bright, and with as much contrast, as the picture that it becomes part of.
cv::Mat in_the_light_of(const cv::Mat& shared, const cv::Mat& picture) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::Scalar own_mean;
  cv::Scalar own_deviation;
  cv::meanStdDev(shared, mean, deviation);
  cv::meanStdDev(picture, own_mean, own_deviation);
  const double gain = deviation[0] / std::max(own_deviation[0], 1.0);
  return (picture - own_mean[0]) * gain + mean[0];
}

cv::Mat place_of(const cv::Mat& shared, const cv::Mat& own, const cv::Mat& mask) {
  return shared + mask.mul(in_the_light_of(shared, own) - shared);
}

void let_pass(const cv::Mat& passing, core::Random& random, cv::Mat& scene) {
  const auto num = static_cast<int>(random.index(kMaxPassing + 1));
  for (int i = 0; i < num; ++i) {
    const auto side = [&](int of_px) {
      return static_cast<int>(random.uniform(kMinPassingSide, kMaxPassingSide) * of_px);
    };
    const cv::Size size(side(scene.cols), side(scene.rows));
    const auto somewhere = [&] {
      const auto x = random.index(static_cast<std::uint64_t>(scene.cols - size.width));
      const auto y = random.index(static_cast<std::uint64_t>(scene.rows - size.height));
      return cv::Rect(cv::Point(static_cast<int>(x), static_cast<int>(y)), size);
    };
    const cv::Rect from = somewhere();
    passing(from).copyTo(scene(somewhere()));
  }
}

// Pixels of the canvas at the corners of a view: upper left, upper right, lower right, lower left.
std::array<cv::Point2f, 4> corners_of_view(core::Random& random) {
  const double side = random.uniform(kMinViewSide, kMaxViewSide);
  const double turn_rad = random.uniform(-kMaxViewTurn_rad, kMaxViewTurn_rad);
  const double x = 0.5 + random.uniform(-kMaxViewShift, kMaxViewShift);
  const double y = 0.5 + random.uniform(-kMaxViewShift, kMaxViewShift);
  std::array<cv::Point2f, 4> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto shift = [&] { return random.uniform(-kMaxCornerShift, kMaxCornerShift); };
    const double right =
        (i == 1 || i == 2 ? 0.5 : -0.5) * side * kCanvas_px.width * (1.0 + shift());
    const double down = (i >= 2 ? 0.5 : -0.5) * side * kCanvas_px.height * (1.0 + shift());
    corners[i] = cv::Point2f(static_cast<float>(x * kCanvas_px.width + std::cos(turn_rad) * right -
                                                std::sin(turn_rad) * down),
                             static_cast<float>(y * kCanvas_px.height + std::sin(turn_rad) * right +
                                                std::cos(turn_rad) * down));
  }
  return corners;
}

cv::Mat view_of(const cv::Mat& place, const cv::Mat& passing, core::Random& random) {
  cv::Mat scene = place.clone();
  let_pass(passing, random, scene);
  const std::array<cv::Point2f, 4> to = corners_of_view(random);
  const auto width = static_cast<float>(kMadeView_px.width);
  const auto height = static_cast<float>(kMadeView_px.height);
  const std::array<cv::Point2f, 4> from = {cv::Point2f(0, 0), cv::Point2f(width, 0),
                                           cv::Point2f(width, height), cv::Point2f(0, height)};
  std::vector<cv::Point2f> pixels;
  for (int row = 0; row < kMadeView_px.height; ++row)
    for (int column = 0; column < kMadeView_px.width; ++column)
      pixels.emplace_back(static_cast<float>(column), static_cast<float>(row));
  cv::perspectiveTransform(pixels, pixels, cv::getPerspectiveTransform(from, to));
  const double bend_px = random.uniform(0.0, kMaxBend) * kCanvas_px.width;
  cv::Mat bent = cv::Mat(pixels, true).reshape(2, kMadeView_px.height);
  std::array<cv::Mat, 2> bends = {smooth_field({5, 4}, kMadeView_px, random) * bend_px,
                                  smooth_field({5, 4}, kMadeView_px, random) * bend_px};
  cv::Mat bend;
  cv::merge(bends.data(), bends.size(), bend);
  bent += bend;
  cv::Mat view;
  cv::remap(scene, view, bent, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
  view.convertTo(view, CV_8U);
  return view;
}

// Of "from=3": 3 if `name` is from.
void read_bound(std::string_view word, std::string_view name, const std::string& source,
                int& bound) {
  const std::string_view number = word.substr(name.size() + 1);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), bound);
  if (error != std::errc() || end != number.data() + number.size() || bound < 0)
    throw core::InputError(
        fmt::format("{}: {}, expected {}=NUMBER of a photo", source, word, name));
}

}  // namespace

bool is_photos(const std::string& source) { return source.starts_with(kPrefix); }

PhotoSource photo_source(const std::string& source) {
  const std::size_t end = source.find('?');
  PhotoSource photos{.folder = source.substr(kPrefix.size(), end - kPrefix.size()),
                     .last = std::numeric_limits<int>::max()};
  std::string_view words = end == std::string::npos ? std::string_view() : source;
  if (!words.empty()) words.remove_prefix(end + 1);
  while (!words.empty()) {
    const std::string_view word = words.substr(0, words.find('&'));
    words.remove_prefix(std::min(words.size(), word.size() + 1));
    if (word.starts_with("from=")) {
      read_bound(word, "from", source, photos.first);
    } else if (word.starts_with("to=")) {
      read_bound(word, "to", source, photos.last);
    } else {
      throw core::InputError(fmt::format("{}: {}, expected from=NUMBER&to=NUMBER", source, word));
    }
  }
  return photos;
}

std::array<cv::Mat, kNumMadeViews> made_views(const Ingredients& ingredients,
                                              core::Random& random) {
  const cv::Mat shared = on_canvas(ingredients.shared);
  const cv::Mat passing = in_the_light_of(shared, on_canvas(ingredients.passing));
  const cv::Mat mask = own_part(random);
  const cv::Mat place = place_of(shared, on_canvas(ingredients.own), mask);
  const cv::Mat look_alike = place_of(shared, on_canvas(ingredients.other), mask);
  std::array<cv::Mat, kNumMadeViews> views;
  for (std::size_t i = 0; i < views.size(); ++i)
    views[i] = view_of(i < 2 ? place : look_alike, passing, random);
  return views;
}

}  // namespace samewhere::pairs
