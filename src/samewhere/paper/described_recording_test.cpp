#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/paper/described_recording.hpp>

namespace samewhere::paper {
namespace {

TEST(WithSource, TheWindowIsInFramesOrSeconds) {
  const pipeline::Config config = pipeline::profile("paper");
  const pipeline::Config frames = with_source(config, "/data/kitchen@149");
  EXPECT_EQ(frames.source, "/data/kitchen");
  EXPECT_EQ(frames.retrieve.window_frames, 149);
  pipeline::Config in_frames = config;
  in_frames.retrieve.window_frames = 7;
  const pipeline::Config seconds = with_source(in_frames, "twin:hotel?seed=3@10s");
  EXPECT_EQ(seconds.source, "twin:hotel?seed=3");
  EXPECT_EQ(seconds.retrieve.window_frames, -1);
  EXPECT_EQ(seconds.retrieve.window_s, 10.0);
}

TEST(WithSource, WithoutAWindowTheConfigHasIt) {
  pipeline::Config config = pipeline::profile("paper");
  config.retrieve.window_frames = 7;
  for (const char* source : {"/data/kitchen", "/data/me@home", "/data/a@", "/data/a@s"}) {
    const pipeline::Config same = with_source(config, source);
    EXPECT_EQ(same.source, source);
    EXPECT_EQ(same.retrieve.window_frames, 7);
  }
  EXPECT_THROW(with_source(config, "/data/a@99999999999999999999"), core::InputError);
}

// Two laps past three walls, as images.
void write_walk(const input::TestFolder& folder, const std::string& name, int num_laps) {
  std::string truth;
  for (int frame = 0; frame < 3 * num_laps; ++frame) {
    folder.write_png(name + "/" + std::to_string(frame) + ".png",
                     cv::Mat(30, 40, CV_8U, cv::Scalar(50 * (frame % 3))));
    for (int other = 0; other < 3 * num_laps; ++other)
      truth += frame % 3 == other % 3 ? "1 " : "0 ";
    truth += "\n";
  }
  folder.write(name + "/same_place.txt", truth);
}

TEST(OpenRecording, ThrowsWithoutPlaces) {
  const input::TestFolder folder;
  write_walk(folder, "walk", 2);
  const auto config = [&](const std::string& source) {
    return with_source(pipeline::profile("paper"), (folder.root() / source).string());
  };
  const OpenRecording recording = open_recording(config("walk@2"));
  EXPECT_EQ(recording.name, "walk");
  EXPECT_EQ(recording.num_frames, 6);
  EXPECT_EQ(recording.config.retrieve.window_frames, 2);
  EXPECT_THROW(open_recording(config("nowhere")), core::InputError);
  std::filesystem::remove(folder.root() / "walk/same_place.txt");
  EXPECT_THROW(open_recording(config("walk@2")), core::InputError);
}

TEST(FileStem, HasPlainLettersOnly) {
  const pipeline::Config config = pipeline::profile("paper");
  EXPECT_EQ(file_stem(with_source(config, "twin:hotel?seed=3&similarity=1@10s")),
            "hotel-seed-3-similarity-1-10s");
  EXPECT_EQ(file_stem(with_source(config, "/data/kitchen/@149")), "kitchen-149");
}

TEST(DescribeRecording, DescribesEachFrameAndTimesUpTo400SpreadEvenly) {
  const input::TestFolder folder;
  write_walk(folder, "short", 2);
  write_walk(folder, "long", 160);
  const pipeline::Config config = pipeline::profile("paper");
  for (const int num_frames : {6, 480}) {
    int num_seen = 0;
    const char* name = num_frames == 6 ? "short@2" : "long@2";
    const auto described = describe_recording(
        open_recording(with_source(config, (folder.root() / name).string())),
        {make_named_describer("hog", config)}, [&](const core::Frame&) { ++num_seen; });
    ASSERT_TRUE(described.has_value());
    EXPECT_EQ(num_seen, num_frames);
    const DescribedViews& views = described->by_describer.front();
    EXPECT_EQ(views.views.size(), static_cast<std::size_t>(num_frames));
    EXPECT_NE(views.checksum, 0u);
    EXPECT_EQ(described->timed_frames.size(), std::min<std::size_t>(400, views.views.size()));
    EXPECT_EQ(views.durations_ms.size(), described->timed_frames.size());
    EXPECT_GT(described->timed_frames.back(), num_frames - 3);
  }
}

TEST(MakeNamedDescriber, IsTheConfiguredOneHogOrANetwork) {
  const pipeline::Config config = pipeline::profile("paper");
  const NamedDescriber paper = make_named_describer(kPaperMethod, config);
  const NamedDescriber network = make_named_describer("autoencoder.onnx", config);
  EXPECT_EQ(paper.name, "paper");
  EXPECT_EQ(network.name, "autoencoder");
  EXPECT_EQ(paper.describer->checksum(), network.describer->checksum());
  EXPECT_NE(make_named_describer("hog", config).describer->checksum(),
            network.describer->checksum());
  EXPECT_THROW(make_named_describer("/nowhere/net.onnx", config), core::InputError);
}

}  // namespace
}  // namespace samewhere::paper
