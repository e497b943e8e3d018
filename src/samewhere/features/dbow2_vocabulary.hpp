#pragma once

#include <filesystem>
#include <string_view>

#include <samewhere/features/vocabulary_tree.hpp>

namespace samewhere::features {

// A vocabulary that DBoW2 has written (Galvez-Lopez and Tardos 2012). Its children and levels are
// at most what it says: branching k, 2 to 100, depth L, 1 to 20. `path` is for messages; both throw
// InputError on a file that is cut short or damaged.
//
// As text, as ORB-SLAM2 has it: "k L scoring weighting", then a line per node, parent before child:
// number of the parent (0: the root), whether it is a word, 32 bytes, weight.
ForeignTree read_dbow2_text(std::string_view text, const std::filesystem::path& path);

// As YAML: `k`, `L`; `nodes`, each with nodeId, parentId, weight and descriptor (32 bytes in
// quotes); `words`, each with wordId and nodeId. Only what DBoW2 writes is understood of YAML.
ForeignTree read_dbow2_yaml(std::string_view text, const std::filesystem::path& path);

// Whether the text may be either.
bool looks_like_dbow2_text(std::string_view text);
bool looks_like_dbow2_yaml(std::string_view text);

}  // namespace samewhere::features
