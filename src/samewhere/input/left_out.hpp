#pragma once

#include <cstddef>
#include <string>

namespace samewhere::input {

// What of an input cannot be used and is left out, while the rest is: counted, the first one kept
// as an example.
class LeftOut {
 public:
  // `why` is a line as an InputError has: place, what was found, what was expected.
  void add(std::string why);

  std::size_t count() const { return count_; }
  const std::string& first() const { return first_; }

  // One warning in the log if anything is left out: "3 of 200 poses are left out; the first: ...".
  void warn(std::size_t num_all, const char* nouns) const;

  // Throws InputError, the first reason and the count, if more than half of all are left out.
  void refuse_most(std::size_t num_all, const char* nouns) const;

 private:
  std::size_t count_ = 0;
  std::string first_;
};

}  // namespace samewhere::input
