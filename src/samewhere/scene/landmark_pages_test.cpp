#include <gtest/gtest.h>

#include <samewhere/core/test_temporary_folder.hpp>
#include <samewhere/scene/landmark_pages.hpp>
#include <samewhere/scene/test_edits.hpp>
#include <samewhere/scene/test_map_file.hpp>

namespace samewhere::scene {
namespace {

constexpr std::size_t kChunkSize = std::tuple_size_v<ChunkedVector<Landmark>::Chunk>;

Landmark landmark(std::uint64_t index) {
  Landmark made;
  made.id = core::LandmarkId(index);
  made.position_in_anchor = {static_cast<double>(index), 2.0, 3.0};
  made.descriptor.fill(static_cast<std::uint8_t>(index));
  for (std::uint64_t i = 0; i <= index % 5; ++i)
    made.observations.push_back({core::KeyframeId(i), static_cast<int>(index)});
  return made;
}

ChunkedVector<Landmark> landmarks(std::size_t count) {
  ChunkedVector<Landmark> made;
  for (std::size_t i = 0; i < count; ++i) made.push_back(landmark(i));
  return made;
}

// Two rounds: what did not change between them is in the file.
void let_rest(LandmarkPages& pages, ChunkedVector<Landmark>& landmarks) {
  pages.step(landmarks, 1);
  pages.step(landmarks, 1);
}

TEST(LandmarkPages, WhatLeftMemoryReadsAsBefore) {
  ChunkedVector<Landmark> known = landmarks(3 * kChunkSize + 1);
  const ChunkedVector<Landmark> before = known;
  LandmarkPages pages;
  let_rest(pages, known);
  for (std::size_t i = 0; i < known.size(); ++i)
    EXPECT_TRUE(is_same(known[i], before[i])) << "landmark " << i;
  EXPECT_FALSE(known.shares_chunk(before, 0));
  EXPECT_TRUE(known.shares_chunk(before, 3)) << "the last chunk still grows";
}

TEST(LandmarkPages, NothingGoesBeforeItRestedForARound) {
  ChunkedVector<Landmark> known = landmarks(4 * kChunkSize);
  const ChunkedVector<Landmark> before = known;
  LandmarkPages pages;
  for (int i = 0; i < 5; ++i) pages.step(known, 4);
  EXPECT_FALSE(known.shares_chunk(before, 0));
  EXPECT_TRUE(known.shares_chunk(before, 1)) << "visited once";
  known.edit(kChunkSize).octave = 3;
  const ChunkedVector<Landmark> changed = known;
  for (int i = 0; i < 3; ++i) pages.step(known, 4);
  EXPECT_TRUE(known.shares_chunk(changed, 1)) << "changed since";
  EXPECT_FALSE(known.shares_chunk(before, 2));
}

TEST(LandmarkPages, ARoundTakesItsStepsHoweverManyChunksThereAre) {
  for (const std::size_t num_chunks : {2U, 11U}) {
    constexpr std::size_t kNumSteps = 10;
    ChunkedVector<Landmark> known = landmarks(num_chunks * kChunkSize);
    const ChunkedVector<Landmark> before = known;
    LandmarkPages pages;
    for (std::size_t i = 0; i < kNumSteps; ++i) pages.step(known, kNumSteps);
    for (std::size_t k = 0; k < num_chunks; ++k)
      EXPECT_TRUE(known.shares_chunk(before, k)) << k << " of " << num_chunks << " too early";
    for (std::size_t i = 0; i < kNumSteps; ++i) pages.step(known, kNumSteps);
    for (std::size_t k = 0; k < num_chunks; ++k)
      EXPECT_FALSE(known.shares_chunk(before, k)) << k << " of " << num_chunks << " too late";
  }
}

TEST(LandmarkPages, WhereThereIsNoRoomAllStaysInMemory) {
  const core::TemporaryFolder nowhere("/nonexistent");
  ChunkedVector<Landmark> known = landmarks(2 * kChunkSize);
  const ChunkedVector<Landmark> before = known;
  LandmarkPages pages;
  let_rest(pages, known);
  let_rest(pages, known);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_TRUE(known.shares_chunk(before, k));
}

TEST(LandmarkPages, AChangeTakesTheChunkOutOfTheFile) {
  ChunkedVector<Landmark> known = landmarks(2 * kChunkSize);
  LandmarkPages pages;
  let_rest(pages, known);
  const ChunkedVector<Landmark> in_file = known;
  known.edit(1).observations.push_back({core::KeyframeId(9), 9});
  EXPECT_EQ(known[1].observations.back().keyframe, core::KeyframeId(9));
  EXPECT_TRUE(is_same(in_file[1], landmark(1))) << "the copy is unchanged";
  EXPECT_TRUE(is_same(known[2], landmark(2)));
  EXPECT_TRUE(known.shares_chunk(in_file, 1));
}

TEST(LandmarkPages, TheOnlyOwnerDoesNotWriteIntoTheFile) {
  ChunkedVector<Landmark> known = landmarks(kChunkSize);
  {
    LandmarkPages pages;
    let_rest(pages, known);
  }
  const Landmark* in_file = &known[0];
  known.edit(0).octave = 3;
  EXPECT_NE(&known[0], in_file);
}

TEST(LandmarkPages, EveryKindOfEditFindsTheSameLandmarks) {
  LandmarkPages pages;
  RandomEdits edits(3);
  MapVersion plain;
  MapVersion paged;
  std::size_t num_in_file = 0;
  for (int i = 0; i < 60; ++i) {
    const Edit edit = edits.next(plain);
    plain = apply(plain, edit);
    paged = apply(paged, edit);
    const ChunkedVector<Landmark> before = paged.landmarks;
    let_rest(pages, paged.landmarks);
    for (std::size_t k = 0; k < before.num_chunks(); ++k)
      num_in_file += paged.landmarks.chunk(k) != before.chunk(k) ? 1 : 0;
  }
  EXPECT_GT(num_in_file, 30U) << "times that a chunk went to the file";
  expect_same(plain, paged);
}

}  // namespace
}  // namespace samewhere::scene
