#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/pipeline/described_recording.hpp>

namespace samewhere::pipeline {
namespace {

TEST(WithSource, TheWindowIsInFramesOrSeconds) {
  const Config config = profile("paper");
  const Config frames = with_source(config, "/data/kitchen@149");
  EXPECT_EQ(frames.source, "/data/kitchen");
  EXPECT_EQ(frames.retrieve.window_frames, 149);
  Config in_frames = config;
  in_frames.retrieve.window_frames = 7;
  const Config seconds = with_source(in_frames, "twin:hotel?seed=3@10s");
  EXPECT_EQ(seconds.source, "twin:hotel?seed=3");
  EXPECT_EQ(seconds.retrieve.window_frames, -1);
  EXPECT_EQ(seconds.retrieve.window_s, 10.0);
}

TEST(WithSource, WithoutAWindowTheConfigHasIt) {
  Config config = profile("paper");
  config.retrieve.window_frames = 7;
  for (const char* source : {"/data/kitchen", "/data/me@home", "/data/a@", "/data/a@s"}) {
    const Config same = with_source(config, source);
    EXPECT_EQ(same.source, source);
    EXPECT_EQ(same.retrieve.window_frames, 7);
  }
  EXPECT_THROW(with_source(config, "/data/a@99999999999999999999"), core::InputError);
}

TEST(MakeDescribers, AreNamedAndNeverTwoTheSame) {
  const Config config = profile("paper");
  for (const char* list : {"", "hog"}) {
    const auto describers = make_describers(list, config);
    ASSERT_EQ(describers.size(), 1u) << list;
    EXPECT_EQ(describers.front().name, "hog");
  }
  for (const char* list : {"hog,hog", "hog,", "hog,/nowhere/net.onnx"})
    EXPECT_THROW(make_describers(list, config), core::InputError) << list;
}

}  // namespace
}  // namespace samewhere::pipeline
