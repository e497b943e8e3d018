#include <utility>

#include <samewhere/node/grid_thread.hpp>

namespace samewhere::node {

GridThread::GridThread(const dense::Config& config, bool has_thread, Publisher& publisher)
    : config_(config), publisher_(publisher) {
  if (!has_thread) return;
  worker_.emplace([this] {
    while (const std::optional<GridJob> job = jobs_.receive()) work(*job);
  });
}

GridThread::~GridThread() { jobs_.close(); }

void GridThread::make(GridJob job) {
  if (!worker_) return work(job);
  jobs_.send_newest(std::move(job));
}

void GridThread::work(const GridJob& job) {
  auto grid = grid_of(job.depths, *job.map, config_);
  why_none_.set(grid ? std::string() : grid.error());
  if (!grid) return;
  grid->header = job.header;
  grid->info.map_load_time = job.header.stamp;
  publisher_.grid(*grid);
}

}  // namespace samewhere::node
