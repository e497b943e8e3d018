#pragma once

#include <string>
#include <utility>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/errors.hpp>

// What every call of the library's interface passes.

namespace samewhere::library {

// Errors of the program become those of the interface.
template <class Work>
auto at_border(const Work& work) {
  try {
    return work();
  } catch (const core::InputError& error) {
    throw InputError(error.what());
  } catch (const core::ContractError& error) {
    throw UsageError(std::string("internal error: ") + error.what());
  }
}

// Lets one thread into a session at a time, and none after an internal error.
class Door {
 public:
  // For the life of a call. `call`: "track()". Throws UsageError if another one is there.
  class Call {
   public:
    Call(Door& door, const std::string& call) : door_(door) {
      if (door_.is_busy_.exchange(true)) {
        throw UsageError(call +
                         ": another call of this session is in progress; expected one thread at a "
                         "time; the session goes on");
      }
    }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;
    ~Call() { door_.is_busy_.set(false); }

   private:
    Door& door_;
  };

  // Throws UsageError after an internal error.
  void require_open(const std::string& call) const {
    if (!why_over_.empty())
      throw UsageError(call + ": the session is over after an error (" + why_over_ + ")");
  }

  // Work after which, if it throws, the session is over.
  template <class Work>
  auto decisive(const Work& work) {
    try {
      return at_border(work);
    } catch (const std::exception& error) {
      why_over_ = error.what();
      throw;
    }
  }

  void reopen() { why_over_.clear(); }

 private:
  core::Guarded<bool> is_busy_{false};
  std::string why_over_;
};

}  // namespace samewhere::library
