#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/channel.hpp>
#include <samewhere/input/newest.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using testing::HasSubstr;

// Frames whose stamp is their position; before frame `slow_at` it waits for leave.
class Camera : public core::Source {
 public:
  Camera(int num_frames, int slow_at, core::Channel<int>& leave)
      : num_frames_(num_frames), slow_at_(slow_at), leave_(leave) {}

  core::SourceInfo info() const override { return {.name = "camera", .is_live = true}; }
  core::Truth truth() const override { return {}; }
  std::optional<core::Frame> next() override {
    if (num_given_ == slow_at_) leave_.receive();
    if (num_given_ == num_frames_) throw core::InputError("somebody pulled the plug");
    core::Frame frame;
    frame.id = core::FrameId(static_cast<std::uint64_t>(num_given_));
    frame.stamp_s = num_given_++;
    return frame;
  }

 private:
  int num_frames_;
  int slow_at_;
  core::Channel<int>& leave_;
  int num_given_ = 0;
};

TEST(Newest, EveryFrameIsGivenOrCountedAndTheLastIsGiven) {
  constexpr int kNumFrames = 1000;
  core::Channel<int> leave(1);
  leave.send(1);
  const auto source = newest(std::make_unique<Camera>(kNumFrames, 0, leave));
  EXPECT_TRUE(source->info().is_live);
  int num_given = 0;
  int num_dropped = 0;
  double last_s = -1.0;
  const std::string said = complaint([&] {
    while (const std::optional<core::Frame> frame = source->next()) {
      EXPECT_EQ(frame->id, core::FrameId(static_cast<std::uint64_t>(num_given++)));
      num_dropped += frame->num_dropped_before;
      EXPECT_EQ(frame->stamp_s, num_given + num_dropped - 1);
      last_s = frame->stamp_s;
    }
  });
  EXPECT_EQ(last_s, kNumFrames - 1);
  EXPECT_EQ(num_given + num_dropped, kNumFrames);
  EXPECT_THAT(said, HasSubstr("pulled the plug"));
  EXPECT_FALSE(source->next());
}

TEST(Newest, AReaderThatWaitsMissesNothing) {
  core::Channel<int> leave(1);
  const auto source = newest(std::make_unique<Camera>(2, 1, leave));
  EXPECT_EQ(source->next().value().num_dropped_before, 0);
  leave.send(1);
  const core::Frame second = source->next().value();
  EXPECT_EQ(second.stamp_s, 1.0);
  EXPECT_EQ(second.num_dropped_before, 0);
}

TEST(Newest, ItMayBeDestroyedWhileNobodyListens) {
  core::Channel<int> leave(1);
  leave.close();
  for (int i = 0; i < 100; ++i) {
    const auto source = newest(std::make_unique<Camera>(1'000'000'000, 0, leave));
    EXPECT_TRUE(i % 2 == 0 || source->next());
  }
}

}  // namespace
}  // namespace samewhere::input
