#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/features/grow_vocabulary.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::run {

struct VocabularyTraining {
  std::vector<std::string> sources;  // recordings, lists or folders of images, rendered walks
  int step = 1;                      // one frame of so many is looked at
  features::GrowSettings grow;
  std::filesystem::path out;
  std::string command;  // for the card
};

struct TrainedVocabulary {
  int num_pictures = 0;
  int num_features = 0;
  int num_words = 0;
};

// `samewhere train words`: a vocabulary of the ORB features of these pictures, and beside it a card
// (JSON: command, sources, numbers, checksum of the file). Progress on stderr. Throws InputError if
// a source or one of its pictures cannot be read, no picture has a feature, or the files cannot be
// written; Interrupted after Ctrl-C; then nothing is written.
TrainedVocabulary train_vocabulary(const VocabularyTraining& training,
                                   const pipeline::Config& config);

}  // namespace samewhere::run
