#include <limits>

#include <gmock/gmock.h>

#include <samewhere/core/file.hpp>
#include <samewhere/scene/test_map_file.hpp>

namespace samewhere::scene {
namespace {

TEST_F(MapFiles, WhatIsLoadedIsWhatWasSavedWhateverTheEdits) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::filesystem::path file_path = path(std::to_string(seed) + ".sw");
    std::optional<MapFile> file = MapFile::create(file_path, {});
    RandomEdits edits(seed);
    core::Random random(seed);
    MapVersion map;
    MapExtras extras;
    for (int i = 0; i < 40; ++i) {
      map = apply(std::move(map), edits.next(map));
      if (random.index(4) == 0) continue;  // two edits in one commit
      const MapExtras added = extras_of(map, random);
      file->commit(map, added);
      extras.frames.insert(extras.frames.end(), added.frames.begin(), added.frames.end());
      extras.descriptors.insert(extras.descriptors.end(), added.descriptors.begin(),
                                added.descriptors.end());
      extras.ledger.insert(extras.ledger.end(), added.ledger.begin(), added.ledger.end());
      if (random.index(8) != 0) continue;
      file.reset();
      file = MapFile::open(file_path, MapAccess::kExtend);
      const StoredMap stored = file->load();
      expect_same(stored.map, map);
      expect_same(stored.extras, extras);
      if (random.index(2) == 0) map = stored.map;  // the next session goes on from the file
    }
    file->commit(map, {});
    file.reset();
    expect_same(MapFile::open(file_path).load().map, map);
    EXPECT_TRUE(!map.merges.empty() && !map.loops.empty() && !map.suspended_loops.empty() &&
                num_live(map.keyframes) < map.keyframes.size())
        << "without these it shows less";
  }
}

TEST_F(MapFiles, ACameraWhosePicturesWereTurnedIsStillToldAsItWasTaken) {
  RandomEdits edits(1);
  MapVersion map;
  while (map.keyframes.size() < 2) map = apply(std::move(map), edits.next(map));
  core::Rig rig = *map.keyframes[0].view.rig;
  rig.body_from_taken_camera = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY())), {0.1, 0.2, 0.3}};
  map.keyframes.edit(0).view.rig = std::make_shared<const core::Rig>(rig);
  MapFile::create(path(), {}).commit(map, {});
  const MapVersion found = MapFile::open(path()).load().map;
  const core::Rig& read = *found.keyframes[0].view.rig;
  ASSERT_TRUE(read.body_from_taken_camera);
  EXPECT_TRUE(is_same(read.body_from_told_camera(), *rig.body_from_taken_camera));
  EXPECT_FALSE(found.keyframes[1].view.rig->body_from_taken_camera);
}

TEST_F(MapFiles, AFramePoseThatIsCommittedAgainIsReplaced) {
  write_small_map();
  StoredMap stored;
  {
    MapFile file = MapFile::open(path(), MapAccess::kExtend);
    stored = file.load();
    stored.extras.frames[1].num_inliers = 12345;
    file.commit(stored.map, {.frames = {stored.extras.frames[1]}});
  }
  expect_same(MapFile::open(path()).load().extras, stored.extras);
}

TEST_F(MapFiles, PicturesAreReadOneByOne) {
  const core::FrameId seen(7, 3);
  const std::string jpeg("not\0really", 10);
  {
    MapFile file = MapFile::create(path(), {});
    RandomEdits edits(3);
    file.commit(apply(MapVersion{}, edits.next(MapVersion{})), {.thumbnails = {{seen, jpeg}}});
  }
  EXPECT_EQ(MapFile::open(path()).thumbnail(seen), jpeg);
  EXPECT_EQ(MapFile::open(path()).thumbnail(core::FrameId(7)), std::nullopt);
  std::string bytes = core::read_file(path());
  bytes[bytes.find(jpeg)] ^= 1;
  core::write_file(path(), bytes);
  EXPECT_THAT(complaint([&] { MapFile::open(path()).thumbnail(seen); }),
              testing::HasSubstr("is damaged: its checksum does not fit"));
}

TEST_F(MapFiles, AReaderSeesTheLastCommitWhileItIsWritten) {
  MapFile file = MapFile::create(path(), {});
  RandomEdits edits(3);
  MapVersion map = apply(MapVersion{}, edits.next(MapVersion{}));
  file.commit(map, {});
  expect_same(MapFile::open(path()).load().map, map);
  map = apply(map, edits.next(map));
  file.commit(map, {});
  expect_same(MapFile::open(path()).load().map, map);
}

TEST_F(MapFiles, AClosedMapIsOnePlainFile) {
  const MapVersion map = write_small_map();
  EXPECT_FALSE(std::filesystem::exists(path("m.sw-wal")));
  EXPECT_FALSE(std::filesystem::exists(path("m.sw-shm")));
  const std::filesystem::perms before = std::filesystem::status(folder_).permissions();
  std::filesystem::permissions(folder_, std::filesystem::perms::owner_write,
                               std::filesystem::perm_options::remove);
  expect_same(MapFile::open(path()).load().map, map);
  std::filesystem::permissions(folder_, before);
}

TEST_F(MapFiles, WhatCouldNotBeReadAgainIsNotWritten) {
  const MapVersion map = write_small_map();
  MapFile file = MapFile::open(path(), MapAccess::kExtend);
  file.load();
  MapVersion odd = map;
  odd.landmarks.edit(3).position_in_anchor.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint([&] { file.commit(odd, {}); }),
            path().string() + ": landmark 3 cannot be saved: it has a position that is none");
  expect_same(MapFile::open(path()).load().map, map);
}

}  // namespace
}  // namespace samewhere::scene
