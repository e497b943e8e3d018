#include <cstdlib>
#include <cstring>
#include <limits>

#include <gmock/gmock.h>

#include <samewhere/features/match_projected.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/scene/test_forged_maps.hpp>

namespace samewhere::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Numbers that break what reads them.
class Forger {
 public:
  Forger(const std::filesystem::path& path, std::uint64_t seed) : path_(path), random_(seed) {}

  // One row of one table becomes another. What was done, for a message.
  std::string forge() {
    table_ = kTables[random_.index(std::size(kTables))];
    const auto numbers = run_sql(path_, fmt::format("SELECT number FROM {}", table_));
    if (numbers.empty()) return "nothing";
    number_ = std::stoll(numbers[random_.index(numbers.size())]);
    const std::uint64_t kind = random_.index(12);
    if (kind == 0) return by_sql("DELETE FROM {0} WHERE number = {1}");
    if (kind == 1) return by_sql("UPDATE {0} SET number = number + 1000000 WHERE number = {1}");
    if (kind == 2)
      return by_sql("UPDATE {0} SET bytes = 'text', checksum = 0.5 WHERE number = {1}");
    if (kind == 3) return by_sql("UPDATE {0} SET number = -number - 1 WHERE number = {1}");
    std::string bytes = bytes_at(number_);
    if (kind == 4) bytes = bytes_at(std::stoll(numbers[random_.index(numbers.size())]));
    if (kind == 5) bytes.resize(random_.index(bytes.size() + 1));
    if (kind == 6) bytes.append(1 + random_.index(40), '\1');
    if (kind >= 7) overwrite(bytes);
    forge_row(path_, table_, number_, bytes);
    return fmt::format("{} {}, kind {}", table_, number_, kind);
  }

 private:
  static constexpr const char* kTables[] = {
      "header", "state",          "rig",   "keyframe", "view",       "slots",  "landmark",
      "loop",   "suspended_loop", "merge", "frame",    "descriptor", "ledger", "thumbnail"};

  std::string by_sql(const char* sql) {
    run_sql(path_, fmt::format(fmt::runtime(sql), table_, number_));
    return fmt::format(fmt::runtime(sql), table_, number_);
  }

  std::string bytes_at(std::int64_t number) const {
    const std::string hex = run_sql(
        path_, fmt::format("SELECT hex(bytes) FROM {} WHERE number = {}", table_, number))[0];
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
      bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    return bytes;
  }

  template <class T>
  void put(std::string& bytes, T value) {
    if (bytes.size() < sizeof value) return;
    const std::size_t at = random_.index(bytes.size() - sizeof value + 1);
    std::memcpy(bytes.data() + at - at % (random_.index(2) == 0 ? sizeof value : 1), &value,
                sizeof value);
  }

  void overwrite(std::string& bytes) {
    constexpr double kDoubles[] = {kNaN,   kInfinity, -kInfinity, 0.0,   -1.0, 1e300,
                                   1e-300, 1e100,     1e30,       -1e12, 2.0,  0.5};
    constexpr std::int64_t kNumbers[] = {0, 1, 2, 3, 5, 9, -1, -2, 1 << 20, 1LL << 32, 1LL << 48};
    for (std::uint64_t i = 0; i <= random_.index(2); ++i) {
      const std::uint64_t kind = random_.index(4);
      if (kind == 0) put(bytes, kDoubles[random_.index(std::size(kDoubles))]);
      if (kind == 1) put(bytes, kNumbers[random_.index(std::size(kNumbers))]);
      if (kind == 2) put(bytes, static_cast<float>(kDoubles[random_.index(std::size(kDoubles))]));
      if (kind == 3) put(bytes, static_cast<std::int32_t>(random_.next()));
    }
  }

  std::filesystem::path path_;
  core::Random random_;
  std::string table_;
  std::int64_t number_ = 0;
};

// Everything that reads a map.
void use(MapVersion map) {
  const features::Config config;
  odometry_poses(map);
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const core::KeyframeId id = map.keyframes[i].id;
    const LocalMap local = build_local_map(map, holder_of(map, id).keyframe, {5, 2});
    features::match_projected({{0, {10.0, 10.0}, 1}}, cv::Mat::zeros(1, 32, CV_8U), map.at(id).view,
                              20.0, config);
    keyframe_showing_most(map, local.landmarks);
    for (int k = 0; k < local.size(); ++k)
      features::octave_at(local.octave[static_cast<std::size_t>(k)],
                          local.range_m[static_cast<std::size_t>(k)], 1.0, config);
  }
  for (std::size_t i = 0; i < map.landmarks.size(); ++i)
    position_in_world(map, survivor_of(map, map.landmarks[i].id));
  while (!map.loops.empty()) {
    Edit edit;
    edit.withdrawn_loops = {map.loops.back().cause};
    map = apply(std::move(map), edit);
  }
  Edit culling;
  for (std::size_t i = 0; i < map.keyframes.size() && culling.culled_keyframes.empty(); ++i)
    if (is_live(map.keyframes[i]) && map.keyframes[i].odometry)
      culling.culled_keyframes = {map.keyframes[i].id};
  apply(std::move(map), culling);
}

// More of them: SAMEWHERE_FORGERIES=100000 build/dev/samewhere_scene_test --gtest_filter=Forged*
TEST_F(ForgedMaps, AnyForgedRowIsRefusedInALineOrCanBeUsed) {
  const char* wanted = std::getenv("SAMEWHERE_FORGERIES");
  const int num_forgeries = wanted == nullptr ? 40 : std::atoi(wanted);
  int num_refused = 0;
  for (int i = 0; i < num_forgeries; ++i) {
    fresh_copy();
    SCOPED_TRACE(
        fmt::format("seed {}: {}", i, Forger(forged(), static_cast<std::uint64_t>(i)).forge()));
    std::string found = "nothing was said";
    try {
      MapFile file = MapFile::open(forged(), MapAccess::kExtend);
      const StoredMap stored = file.load();
      found = "none";
      use(stored.map);
      file.commit(stored.map, {.ledger = {"{}"}});
    } catch (const core::InputError& error) {
      EXPECT_NE(found, "none") << "refused when it was used: " << error.what();
      EXPECT_THAT(error.what(), AllOf(HasSubstr("forged.sw"), testing::Not(HasSubstr("\n"))));
      ++num_refused;
      continue;
    } catch (const std::exception& error) {
      FAIL() << error.what();
    }
    EXPECT_EQ(complaint_on_forged(), "none") << "what was committed can be read";
  }
  EXPECT_GT(num_refused, num_forgeries / 3) << "the rest changed what may be anything";
}

}  // namespace
}  // namespace samewhere::scene
