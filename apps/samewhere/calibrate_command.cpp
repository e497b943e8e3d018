#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "commands.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/geometry/board_frames.hpp>
#include <samewhere/geometry/calibration.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/image_file.hpp>
#include <samewhere/input/open.hpp>
#include <samewhere/input/video_plugin.hpp>

namespace samewhere::app {
namespace {

struct CalibrateCommand {
  std::string images;
  std::string board;
  double square_m = 0.0;
  std::string out;
};

// "9x6".
geometry::Board parse_board(const std::string& text, double square_m) {
  if (!std::isfinite(square_m))
    throw core::InputError(fmt::format("--square {}: expected a finite number", square_m));
  geometry::Board board{.square_m = square_m};
  const char* const end = text.data() + text.size();
  const auto [cross, error] = std::from_chars(text.data(), end, board.num_columns);
  if (error == std::errc{} && cross != end && *cross == 'x') {
    const auto [last, row_error] = std::from_chars(cross + 1, end, board.num_rows);
    const auto is_sound = [](int count) { return count >= 3 && count <= 100; };
    if (row_error == std::errc{} && last == end && is_sound(board.num_columns) &&
        is_sound(board.num_rows)) {
      return board;
    }
  }
  throw core::InputError(fmt::format(
      "--board {}: expected COLUMNSxROWS of inner corners, 3 to 100 each, such as 9x6", text));
}

// The boards found in the pictures of a folder or list.
struct Views {
  cv::Size size_px;
  std::vector<std::string> names;  // of those with a board
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<std::string> names_without;
};

// A picture from a file or a video.
void add_view(const cv::Mat& image, const std::string& name, const geometry::Board& board,
              Views& views) {
  if (views.size_px.empty()) views.size_px = image.size();
  if (image.size() != views.size_px) {
    throw core::InputError(fmt::format("{}: is {} x {} pixels, expected {} x {} as the first image",
                                       name, image.cols, image.rows, views.size_px.width,
                                       views.size_px.height));
  }
  if (auto corners = geometry::find_board(image, board)) {
    views.names.push_back(name);
    views.corners.push_back(*std::move(corners));
  } else {
    views.names_without.push_back(name);
  }
}

Views look_in_pictures(const std::string& images, const geometry::Board& board) {
  Views views;
  input::Config config;
  config.depth = false;
  config.needs_calibration = false;
  const std::vector<input::FrameFiles> frames = input::read_recording(images, config).frames;
  core::Progress progress("pictures", static_cast<int>(frames.size()));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    core::stop_if_interrupted();
    add_view(input::read_image(frames[i].images.front()), frames[i].name, board, views);
    progress.update(static_cast<int>(i) + 1);
  }
  return views;
}

// The views of `all` that lie apart from each other. Those that repeat one another would make the
// result look surer than it is.
Views views_apart(const Views& all) {
  constexpr std::size_t kMaxViews = 40;
  constexpr double kMinShare = 0.02;  // of the width
  Views apart{all.size_px, {}, {}, {}};
  for (const std::size_t i :
       geometry::spread_views(all.corners, kMaxViews, kMinShare * all.size_px.width)) {
    apart.names.push_back(all.names[i]);
    apart.corners.push_back(all.corners[i]);
  }
  return apart;
}

// The board is looked for in the sharpest frame of each half second, or of longer stretches of a
// long video.
Views look_in_video(const std::string& video, const geometry::Board& board) {
  constexpr double kStretch_s = 0.5;
  constexpr double kMaxStretches = 120.0;
  const auto decoder = input::open_decoder(video, false, input::video_plugin_path());
  const double rate_hz = decoder->frame_rate_hz() > 0.0 ? decoder->frame_rate_hz() : 30.0;
  const double lasts_s = decoder->num_frames() / rate_hz;
  geometry::SharpestFrames sharpest(std::max(kStretch_s, lasts_s / kMaxStretches));
  core::Progress progress("frames", decoder->num_frames());
  Views all;
  int num_read = 0;
  for (auto picture = decoder->next(); !picture.image.empty(); picture = decoder->next()) {
    core::stop_if_interrupted();
    const std::string name = fmt::format("frame {}", num_read);
    const double stamp_s = num_read++ / rate_hz;
    if (const auto frame = sharpest.add({std::move(picture.image), name}, stamp_s))
      add_view(frame->image, frame->name, board, all);
    progress.update(num_read);
  }
  if (const auto frame = sharpest.finish()) add_view(frame->image, frame->name, board, all);
  progress.finish();
  Views apart = views_apart(all);
  core::print(
      "{} frames of {} read; {} sharp frames searched, {} with the board, {} distinct views used\n",
      num_read, video, all.names.size() + all.names_without.size(), all.names.size(),
      apart.names.size());
  return apart;
}

void print_without(const Views& views) {
  if (views.names_without.empty()) return;
  core::print("no board in {} of {} pictures: {}\n", views.names_without.size(),
              views.names.size() + views.names_without.size(),
              fmt::join(views.names_without, ", "));
}

void print_calibration(const geometry::Calibration& found, const Views& views) {
  core::print("reprojection error, pixels (RMS)\n");
  const auto is_left_out = [&found](std::size_t view) {
    return std::binary_search(found.left_out.begin(), found.left_out.end(), view);
  };
  for (std::size_t i = 0; i < views.names.size(); ++i) {
    core::print(
        "  {:6.3f}  {}{}\n", found.view_rmse_px[i], views.names[i],
        is_left_out(i) ? "  left out: another zoom or camera, or a board that is not flat?" : "");
  }
  const core::PinholeRadtan& c = found.camera;
  core::print("  {:6.3f}  all {} pictures{}\n\n", found.rmse_px,
              views.names.size() - found.left_out.size(), found.left_out.empty() ? "" : " used");
  core::print("fx {:.2f}  fy {:.2f}  cx {:.2f}  cy {:.2f} px, fx and fy to {:.1f} %\n", c.fx_px,
              c.fy_px, c.cx_px, c.cy_px, 100.0 * found.focal_sd_ratio);
  core::print("k1 {:.4f}  k2 {:.4f}  p1 {:.5f}  p2 {:.5f}\n\n", c.k1, c.k2, c.p1, c.p2);
}

void execute(const CalibrateCommand& command) {
  core::catch_interrupts();
  const geometry::Board board = parse_board(command.board, command.square_m);
  const Views views = input::is_video(command.images) ? look_in_video(command.images, board)
                                                      : look_in_pictures(command.images, board);
  print_without(views);
  const geometry::Calibration found = geometry::calibrate(board, views.corners, views.size_px);
  print_calibration(found, views);
  core::write_file(command.out, fmt::format("# {} pictures of a board, {:.3f} px RMS\n{}",
                                            views.names.size() - found.left_out.size(),
                                            found.rmse_px, input::camera_file_text(found.camera)));
  core::print("{}\n", command.out);
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  auto command = std::make_shared<CalibrateCommand>();
  CLI::App* sub =
      app.add_subcommand("calibrate", "Calibrate a camera from images of a checkerboard");
  sub->add_option("IMAGES", command->images,
                  "a folder or a list of images, or a video, of one camera")
      ->required();
  sub->add_option("--board", command->board,
                  "inner corners of the board, where four squares meet: COLUMNSxROWS")
      ->required();
  sub->add_option("--square", command->square_m, "side of a square, m")
      ->required()
      ->check(CLI::Range(1e-4, 10.0));
  sub->add_option("--out", command->out, "the camera file to write")->required();
  sub->callback([command] { execute(*command); });
  sub->footer(
      "Example:\n"
      "  samewhere calibrate boards/ --board 9x6 --square 0.025 --out camera.txt\n"
      "  samewhere calibrate board.mp4 --board 9x6 --square 0.025 --out camera.txt\n"
      "The file: the 3 rows of the camera matrix, k1 k2 p1 p2 k3, width height. It is valid\n"
      "for images of this size alone.\n"
      "Take ten images or more; tilt the board differently in each and move it to the corners\n"
      "of the image. From a video, sharp frames with distinct views of the board are used.\n"
      "An image whose error is several times that of the others is left out and named.");
}

}  // namespace samewhere::app
