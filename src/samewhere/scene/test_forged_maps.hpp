#pragma once

#include <limits>
#include <stdexcept>
#include <string>

#include <samewhere/scene/map_rows.hpp>
#include <samewhere/scene/test_forged_map.hpp>
#include <samewhere/scene/test_map_file.hpp>

namespace samewhere::scene {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A small map, and copies of it in which rows or the schema are forged.
class ForgedMaps : public MapFiles {
 protected:
  ForgedMaps() {
    MapFile file = MapFile::create(path(), {{"features.num_features", "1000"}});
    RandomEdits edits(7);
    core::Random random(7);
    for (int i = 0; i < kNumKeyframes; ++i) {
      map_ = apply(std::move(map_), edits.next(map_));
      MapExtras extras = extras_of(map_, random);
      extras.thumbnails = {{map_.keyframes.back().view.frame, "a picture"}};
      file.commit(map_, extras);
    }
  }

  std::filesystem::path forged() const { return path("forged.sw"); }

  void fresh_copy() const {
    std::filesystem::copy_file(path(), forged(), std::filesystem::copy_options::overwrite_existing);
  }

  std::string complaint_on_forged() const {
    return complaint([&] { MapFile::open(forged()).load(); });
  }

  std::string complaint_after(const std::string& sql) const {
    fresh_copy();
    run_sql(forged(), sql);
    return complaint_on_forged();
  }

  // Of a copy of the map in which the row has other bytes.
  std::string complaint_with(const char* table, std::size_t number, std::string_view bytes) const {
    fresh_copy();
    forge_row(forged(), table, static_cast<std::int64_t>(number), bytes);
    return complaint_on_forged();
  }
  // Whose view has other features or another picture.
  std::string complaint_with_view(const features::Features& f, int width_px = 640,
                                  int height_px = 480) const {
    ByteWriter writer;
    writer(map_.keyframes[0].view.frame, 0.0, std::uint64_t{0}, width_px, height_px, f);
    return complaint_with("view", 0, writer.bytes());
  }

  features::Features first_features() const { return *map_.keyframes[0].view.features; }

  template <class IsIt>
  Landmark landmark_that(const IsIt& is_it) const {
    for (std::size_t i = 0; i < map_.landmarks.size(); ++i)
      if (is_it(map_.landmarks[i])) return map_.landmarks[i];
    throw std::runtime_error("the map has no such landmark");
  }

  MapVersion map_;
};

}  // namespace samewhere::scene
