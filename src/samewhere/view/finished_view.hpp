#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <samewhere/core/channel.hpp>
#include <samewhere/view/server.hpp>

namespace samewhere::view {

// Shows finished runs and map files in browsers; several stand side by side. Verdicts of a
// run can be overridden on its page, as by `samewhere ledger`.
class FinishedView {
 public:
  // Folders of runs, or map files. Throws InputError if one cannot be read or the place not served.
  FinishedView(const std::vector<std::filesystem::path>& paths, const Place& place,
               const std::string& token);

  std::string url() const { return server_->url(); }

 private:
  // What is shown of a path.
  struct Shown {
    std::filesystem::path path;
    std::string title;
    core::Guarded<Page> page;
    core::Guarded<int> overriding;  // one at a time
  };

  Routes routes(const std::string& token);
  void add_routes(std::size_t number, Routes& routes);
  bool are_all_runs() const;
  std::string compared() const;
  void read(std::size_t number);
  Answer override_verdict(std::size_t number, const std::string& body);

  std::vector<std::unique_ptr<Shown>> shown_;
  std::unique_ptr<Server> server_;  // last: its threads use the others
};

// A page with other pages side by side.
struct Beside {
  std::string title;
  std::string path;  // with the token
};
// `compared`: the path of a page that compares them; empty: there is none.
std::string side_by_side_html(const std::vector<Beside>& pages, const std::string& compared);

}  // namespace samewhere::view
