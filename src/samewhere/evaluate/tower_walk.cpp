#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/evaluate/tower_walk.hpp>

namespace samewhere::evaluate {
namespace {

const WalkPlace& place_at(const std::vector<WalkPlace>& walk, int position) {
  if (position < 0 || position >= static_cast<int>(walk.size()))
    throw core::InputError(
        fmt::format("position {} is outside the walk of {} images", position, walk.size()));
  return walk[static_cast<std::size_t>(position)];
}

}  // namespace

std::vector<WalkPlace> read_walk(const std::filesystem::path& path) {
  std::vector<WalkPlace> walk;
  for (const core::TextLine& line : core::read_text_lines(path)) {
    if (line.words.size() < 2)
      throw core::InputError(fmt::format("{}: found {} words, expected 'image floor [clip]'",
                                         line.place, line.words.size()));
    walk.push_back({line.words[1], line.words.size() > 2 ? line.words[2] : line.words[1]});
  }
  return walk;
}

WalkCounts count_walk(const std::vector<WalkPlace>& walk, const std::vector<Match>& accepted) {
  WalkCounts counts;
  for (const Match& loop : accepted) {
    const WalkPlace& query = place_at(walk, loop.query);
    const WalkPlace& match = place_at(walk, loop.match);
    const bool is_same_floor = query.floor == match.floor;
    ++counts.num_loops;
    counts.num_false += is_same_floor ? 0 : 1;
    counts.num_same_floor += is_same_floor ? 1 : 0;
    counts.num_same_clip += is_same_floor && query.clip == match.clip ? 1 : 0;
  }
  return counts;
}

}  // namespace samewhere::evaluate
