#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/prefetch.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using testing::HasSubstr;

// `num_frames` empty frames, then the end or an error.
class CountingSource : public core::Source {
 public:
  CountingSource(int num_frames, bool ends_in_error)
      : num_frames_(num_frames), ends_in_error_(ends_in_error) {}

  core::SourceInfo info() const override { return {.name = "count", .num_frames = num_frames_}; }
  core::Truth truth() const override { return {.trajectory = {{1.0, {}}}}; }
  std::optional<core::Frame> next() override {
    if (num_given_ == num_frames_) {
      if (ends_in_error_) throw core::InputError("frame 3 is broken");
      return std::nullopt;
    }
    core::Frame frame;
    frame.id = core::FrameId(static_cast<std::uint64_t>(num_given_++));
    return frame;
  }

 private:
  int num_frames_;
  bool ends_in_error_;
  int num_given_ = 0;
};

TEST(Prefetch, AllFramesComeInOrderAndThenNothing) {
  const auto source = prefetched(std::make_unique<CountingSource>(1000, false));
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const std::optional<core::Frame> frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->id, core::FrameId(i));
  }
  EXPECT_FALSE(source->next());
  EXPECT_FALSE(source->next());
}

TEST(Prefetch, InfoAndTruthPassThrough) {
  const auto source = prefetched(std::make_unique<CountingSource>(7, false));
  EXPECT_EQ(source->info().name, "count");
  EXPECT_EQ(source->info().num_frames, 7);
  EXPECT_EQ(source->truth().trajectory.size(), 1U);
}

TEST(Prefetch, AnErrorComesAfterTheGoodFramesThenNothing) {
  const auto source = prefetched(std::make_unique<CountingSource>(3, true));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(source->next()) << i;
  EXPECT_THAT(complaint([&] { source->next(); }), HasSubstr("frame 3 is broken"));
  EXPECT_FALSE(source->next());
}

TEST(Prefetch, ItMayBeDroppedAtAnyTime) {
  for (int num_read = 0; num_read < 50; ++num_read) {
    for (const bool ends_in_error : {false, true}) {
      const auto source = prefetched(std::make_unique<CountingSource>(num_read + 2, ends_in_error));
      for (int i = 0; i < num_read; ++i) ASSERT_TRUE(source->next());
    }
  }
}

}  // namespace
}  // namespace samewhere::input
