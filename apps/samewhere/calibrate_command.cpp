#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "commands.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/geometry/calibration.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/image_file.hpp>
#include <samewhere/input/open.hpp>

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

void add_view(const input::FrameFiles& files, const geometry::Board& board, Views& views) {
  const cv::Mat image = input::read_image(files.images.front());
  if (views.size_px.empty()) views.size_px = image.size();
  if (image.size() != views.size_px) {
    throw core::InputError(fmt::format("{}: is {} x {} pixels, expected {} x {} as the first image",
                                       files.images.front().string(), image.cols, image.rows,
                                       views.size_px.width, views.size_px.height));
  }
  if (auto corners = geometry::find_board(image, board)) {
    views.names.push_back(files.name);
    views.corners.push_back(*std::move(corners));
  } else {
    views.names_without.push_back(files.name);
  }
}

Views look_for_boards(const std::string& images, const geometry::Board& board) {
  Views views;
  for (const input::FrameFiles& files : input::read_recording(images, {}).frames) {
    core::stop_if_interrupted();
    add_view(files, board, views);
  }
  return views;
}

void print_without(const Views& views) {
  if (views.names_without.empty()) return;
  core::print("no board in {} of {} pictures: {}\n", views.names_without.size(),
              views.names.size() + views.names_without.size(),
              fmt::join(views.names_without, ", "));
}

void print_calibration(const geometry::Calibration& found, const Views& views) {
  core::print("reprojection error, pixels (RMS)\n");
  for (std::size_t i = 0; i < views.names.size(); ++i) {
    core::print("  {:6.3f}  {}\n", found.view_rmse_px[i], views.names[i]);
  }
  const core::PinholeRadtan& c = found.camera;
  core::print("  {:6.3f}  all {} pictures\n\n", found.rmse_px, views.names.size());
  core::print("fx {:.2f}  fy {:.2f}  cx {:.2f}  cy {:.2f} px, fx and fy to {:.1f} %\n", c.fx_px,
              c.fy_px, c.cx_px, c.cy_px, 100.0 * found.focal_sd_ratio);
  core::print("k1 {:.4f}  k2 {:.4f}  p1 {:.5f}  p2 {:.5f}\n\n", c.k1, c.k2, c.p1, c.p2);
}

void execute(const CalibrateCommand& command) {
  core::catch_interrupts();
  const geometry::Board board = parse_board(command.board, command.square_m);
  const Views views = look_for_boards(command.images, board);
  print_without(views);
  const geometry::Calibration found = geometry::calibrate(board, views.corners, views.size_px);
  print_calibration(found, views);
  core::write_file(command.out,
                   fmt::format("# {} pictures of a board, {:.3f} px RMS\n{}", views.names.size(),
                               found.rmse_px, input::camera_file_text(found.camera)));
  core::print("{}\n", command.out);
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  auto command = std::make_shared<CalibrateCommand>();
  CLI::App* sub = app.add_subcommand("calibrate", "A camera file from pictures of a checkerboard");
  sub->add_option("IMAGES", command->images, "a folder or a list of images, all of one camera")
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
      "The file: the 3 rows of the camera matrix, k1 k2 p1 p2 k3, width height. With it pictures\n"
      "of another size are refused.\n"
      "Take ten pictures or more; tilt the board differently in each and bring it to the corners\n"
      "of the picture.");
}

}  // namespace samewhere::app
