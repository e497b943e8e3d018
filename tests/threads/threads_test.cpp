// Number of threads that the twin building starts, and the error if the system refuses one.
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <pthread.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/ordered_workers.hpp>
#include <samewhere/core/share_out.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace {

constexpr int kPlenty = 1000;
int num_started = 0;
int most_threads = kPlenty;

}  // namespace

// Replaces the system function: every thread of this program is counted.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*work)(void*), void* argument) {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (num_started == most_threads) return EAGAIN;
  ++num_started;
  return create(thread, attributes, work, argument);
}

namespace samewhere::test {
namespace {

using core::OrderedWorkers;
using core::share_out;
using twin::Config;
using twin::open_twin;
using twin::Walkthrough;

TEST(Threads, ARefusedThreadEndsTheOthersAndIsReported) {
  for (const int num_allowed : {0, 1, 3}) {
    num_started = 0;
    most_threads = num_allowed;
    try {
      const OrderedWorkers<int> workers(1000, 4, [](int index) { return index; });
      ADD_FAILURE() << "four workers with " << num_allowed << " threads";
    } catch (const core::InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("a thread cannot be started: "));
    }
    EXPECT_EQ(num_started, num_allowed);
    EXPECT_THROW(share_out(9, num_allowed + 2, [](int) {}), core::InputError);
  }
  most_threads = kPlenty;
}

TEST(Threads, WorkIsSharedAmongTheGivenNumberOfThreads) {
  for (const int num_threads : {1, 2, 5}) {
    num_started = 0;
    std::vector<int> times(23, 0);
    share_out(23, num_threads, [&](int i) { ++times[static_cast<std::size_t>(i)]; });
    EXPECT_THAT(times, testing::Each(1));
    EXPECT_EQ(num_started, num_threads - 1) << "beside the caller's";
  }
}

TEST(Threads, AnErrorInAnyShareIsRethrown) {
  for (const int bad : {0, 1, 6}) {
    const auto work = [bad](int i) {
      if (i == bad) throw std::runtime_error("no light");
    };
    EXPECT_THROW(share_out(7, 3, work), std::runtime_error) << bad;
  }
}

TEST(Threads, OneWorkerStartsOneThreadForIlluminationToo) {
  ASSERT_EQ(unsetenv("SAMEWHERE_CACHE"), 0);
  const auto source = open_twin("twin:office-loop?seed=3", {.num_frames = 1, .num_workers = 1});
  num_started = 0;
  ASSERT_TRUE(source->next());
  EXPECT_EQ(num_started, 1) << "the rendering thread; without a cache there is no reader";
}

// All pictures of a sequence, and the number of threads that were started for them.
struct Watched {
  std::vector<cv::Mat> pictures;
  int num_threads = 0;
};

Watched watched(const std::shared_ptr<const Walkthrough>& walk, const Config& config) {
  Watched watched;
  const auto source = open_twin(walk, config);
  num_started = 0;
  while (const auto frame = source->next()) {
    EXPECT_EQ(frame->id, core::FrameId(watched.pictures.size()));
    watched.pictures.push_back(frame->images.at(0));
  }
  watched.num_threads = num_started;
  return watched;
}

bool is_same(const std::vector<cv::Mat>& a, const std::vector<cv::Mat>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const cv::Mat& x, const cv::Mat& y) {
    return cv::norm(x, y, cv::NORM_INF) == 0.0;
  });
}

// The first three pictures of the sequence are cached. Two threads may start: enough to read them,
// too few to compute the illumination.
void expect_failure_is_permanent(const std::shared_ptr<const Walkthrough>& walk,
                                 const Config& config) {
  const auto source = open_twin(walk, config);
  num_started = 0;
  most_threads = 2;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(source->next()) << i;
  EXPECT_THROW(source->next(), core::InputError);
  most_threads = kPlenty;
  EXPECT_THROW(source->next(), core::InputError) << "it must not be tried again";
}

TEST(Threads, CachedPicturesNeedNoIlluminationAndAMissingOneIsRendered) {
  const auto cache =
      std::filesystem::path(testing::TempDir()) / ("samewhere_threads_" + std::to_string(getpid()));
  ASSERT_EQ(setenv("SAMEWHERE_CACHE", cache.c_str(), 1), 0);
  const Config config{.num_frames = 5, .num_workers = 2};
  const auto walk =
      std::make_shared<const Walkthrough>(twin::parse_spec("twin:office-loop?seed=3"), config);
  const Watched rendered = watched(walk, config);
  ASSERT_EQ(rendered.pictures.size(), 5U);
  EXPECT_GT(rendered.num_threads, 2) << "those of the illumination, then two that render";
  const Watched kept = watched(walk, config);
  EXPECT_TRUE(is_same(kept.pictures, rendered.pictures));
  EXPECT_EQ(kept.num_threads, 2) << "only readers of the cache";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(cache)) {
    if (entry.path().filename() == "000003.pictures") std::filesystem::remove(entry.path());
  }
  expect_failure_is_permanent(walk, config);
  const Watched mended = watched(walk, config);
  EXPECT_TRUE(is_same(mended.pictures, rendered.pictures));
  EXPECT_GT(mended.num_threads, 4);
  EXPECT_EQ(watched(walk, config).num_threads, 2) << "it is cached again";
  std::filesystem::remove_all(cache);
}

}  // namespace
}  // namespace samewhere::test
