#include <samewhere/run/watcher.hpp>

namespace samewhere::run {

MapPlan watched(MapPlan plan, Watcher* watcher) {
  if (watcher == nullptr) return plan;
  plan.watch = [watcher, watch = plan.watch](const auto& map, const pipeline::MapNews& news) {
    watcher->see_thumbnails(news.thumbnails);
    if (watch) watch(map, news);
  };
  return plan;
}

}  // namespace samewhere::run
