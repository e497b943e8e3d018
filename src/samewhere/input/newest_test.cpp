#include <chrono>
#include <vector>

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
    if (num_given_ == num_frames_) throw core::InputError("the camera was unplugged");
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
  EXPECT_THAT(said, HasSubstr("was unplugged"));
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

TEST(Newest, ItMayBeDestroyedWhileNoFrameIsTaken) {
  core::Channel<int> leave(1);
  leave.close();
  for (int i = 0; i < 100; ++i) {
    const auto source = newest(std::make_unique<Camera>(1'000'000'000, 0, leave));
    EXPECT_TRUE(i % 2 == 0 || source->next());
  }
}

// Frames a tenth of a second apart, the first at 50 s.
class PlayedRecording : public core::Source {
 public:
  explicit PlayedRecording(int num_frames, double step_s = 0.1)
      : num_frames_(num_frames), step_s_(step_s) {}

  core::SourceInfo info() const override { return {.name = "walk", .num_frames = num_frames_}; }
  core::Truth truth() const override { return {}; }
  std::optional<core::Frame> next() override {
    if (num_given_ == num_frames_) return std::nullopt;
    core::Frame frame;
    frame.id = core::FrameId(static_cast<std::uint64_t>(num_given_));
    frame.stamp_s = 50.0 + step_s_ * num_given_++;
    return frame;
  }

 private:
  int num_frames_;
  double step_s_;
  int num_given_ = 0;
};

// A clock that stands still until it is told to go on.
struct ToldClock {
  core::Channel<double> asked{10};
  core::Channel<bool> leave{10};

  WaitUntil wait() {
    return [this](double since_first_s) {
      asked.send(since_first_s);
      return leave.receive().value_or(false);
    };
  }
  void go_on(int num_frames) {
    for (int i = 0; i < num_frames; ++i) leave.send(true);
  }
  void expect_asked(std::vector<double> times_s) {
    for (const double time_s : times_s) EXPECT_NEAR(asked.receive().value(), time_s, 1e-9);
  }
};

TEST(Played, OfTheFramesThatAreDueTheNewestIsGivenAndTheOthersAreCounted) {
  ToldClock clock;
  const auto source = played(std::make_unique<PlayedRecording>(6), clock.wait());
  EXPECT_TRUE(source->info().is_live);
  clock.go_on(1);
  EXPECT_EQ(source->next().value().stamp_s, 50.0);
  clock.expect_asked({0.0, 0.1});
  clock.go_on(3);  // 1, 2 and 3 are due, 4 is not
  clock.expect_asked({0.2, 0.3, 0.4});
  const core::Frame newest = source->next().value();
  EXPECT_NEAR(newest.stamp_s, 50.3, 1e-9);
  EXPECT_EQ(newest.num_dropped_before, 2);
  EXPECT_EQ(newest.id, core::FrameId(1));
  clock.go_on(1);
  const core::Frame in_time = source->next().value();
  EXPECT_NEAR(in_time.stamp_s, 50.4, 1e-9);
  EXPECT_EQ(in_time.num_dropped_before, 0);
  clock.go_on(1);
  EXPECT_NEAR(source->next().value().stamp_s, 50.5, 1e-9) << "the last is given";
  EXPECT_FALSE(source->next());
}

TEST(Played, NothingIsPlayedBeforeTheFirstFrameIsAskedFor) {
  ToldClock clock;
  clock.leave.close();
  played(std::make_unique<PlayedRecording>(3), clock.wait()).reset();
  clock.asked.close();
  EXPECT_FALSE(clock.asked.receive());
}

TEST(Played, NothingComesAfterTheWaitWasGivenUp) {
  const auto source =
      played(std::make_unique<PlayedRecording>(5), [](double s) { return s < 0.15; });
  double last_s = 0.0;
  while (const auto frame = source->next()) last_s = frame->stamp_s;
  EXPECT_NEAR(last_s, 50.1, 1e-9);
}

TEST(Played, ByTheClockNoFrameComesBeforeItsTime) {
  const auto source = played(std::make_unique<PlayedRecording>(3, 0.02));
  const auto start = std::chrono::steady_clock::now();
  while (const auto frame = source->next()) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    EXPECT_GE(passed.count(), frame->stamp_s - 50.0 - 1e-9) << frame->stamp_s;
  }
}

TEST(Played, ItMayBeDestroyedLongBeforeTheNextFrameIsDue) {
  for (int i = 0; i < 20; ++i) {
    const auto source = played(std::make_unique<PlayedRecording>(3, 3600.0));
    EXPECT_TRUE(i % 2 == 0 || source->next());
  }
}

}  // namespace
}  // namespace samewhere::input
