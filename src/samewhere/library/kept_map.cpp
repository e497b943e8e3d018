#include <samewhere/core/errors.hpp>
#include <samewhere/library/kept_map.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/run/map_saver.hpp>

namespace samewhere::library {

void KeptMap::note(const scene::MapVersion& map, const pipeline::MapNews& news) {
  content_.with([&](Content& content) {
    content.map = map;
    for (const core::FramePose& frame : news.frames) content.frames[frame.frame] = frame;
    content.descriptors.insert(content.descriptors.end(), news.descriptors.begin(),
                               news.descriptors.end());
    content.rows.insert(content.rows.end(), news.rows.begin(), news.rows.end());
  });
}

void KeptMap::save(const std::filesystem::path& file, const pipeline::Config& config,
                   std::uint64_t describer_checksum) {
  const Content content = content_.get();
  if (content.map.keyframes.empty())
    throw core::InputError(file.string() + ": there is no map yet; nothing is saved");
  scene::MapExtras extras{
      .frames = {}, .descriptors = content.descriptors, .ledger = {}, .thumbnails = {}};
  for (const auto& [id, frame] : content.frames) extras.frames.push_back(frame);
  for (const core::LedgerRow& row : content.rows)
    extras.ledger.push_back(report::ledger_row_json(row));
  const core::Rig& rig = *content.map.keyframes[0].view.rig;
  scene::MapFile::create(file, run::map_header(config, rig, describer_checksum))
      .commit(content.map, extras);
}

}  // namespace samewhere::library
