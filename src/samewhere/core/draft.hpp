#pragma once

#include <filesystem>
#include <string_view>

#include <samewhere/core/open_file.hpp>

namespace samewhere::core {

// A file that gets its name only after it is completely written and synced: at any time the name
// refers to the old or to the new content. Until then the file has no name at all or, where the
// file system lacks that, a unique temporary one (NAME.partial-PROCESS-NUMBER beside it).
class Draft {
 public:
  // All of these throw InputError naming the path and the system's reason (no space left).
  Draft(const std::filesystem::path& path, std::string_view content);
  Draft(Draft&& other) noexcept;
  Draft& operator=(Draft&&) = delete;
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  ~Draft();

  // Gives it its name, in place of what has it: a link is replaced, and that which it leads to
  // stays. To be called once.
  void replace();
  // The same where nothing has the name yet. Returns false if something has.
  bool publish_new();

  const std::filesystem::path& path() const { return path_; }

 private:
  int link_to(const std::filesystem::path& name) const;
  bool has_name() const { return !partial_.empty(); }

  std::filesystem::path path_;
  std::filesystem::path partial_;  // its name until then, if it has one
  OpenFile file_;
};

// So that a name, too, survives the loss of power. Where the system cannot, it is as good as it
// gets.
void sync_folder_of(const std::filesystem::path& path);

// Why the system would not have a new file in this folder, as its error number; 0: it would. Leaves
// none.
int error_of_new_file(const std::filesystem::path& folder);

// Of a temporary file: what its name has after the one that it stands for, before two numbers.
inline constexpr std::string_view kPartial = ".partial-";

}  // namespace samewhere::core
