#pragma once

#include <algorithm>
#include <exception>
#include <functional>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/errors.hpp>

namespace samewhere::core {

// How many threads the machine runs at a time, at least 1. For sharing out work whose result does
// not depend on it.
inline int num_hardware_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// A thread that runs one function to its end. Throws InputError if the system refuses one more. An
// exception in the function comes out of join(). The destructor joins and swallows it: call
// join() first to receive the exception. The owner of channels that the function waits on closes
// them first.
class WorkerThread {
 public:
  explicit WorkerThread(std::function<void()> work)
      : thread_(started([this, work = std::move(work)] {
          try {
            work();
          } catch (...) {
            error_ = std::current_exception();
          }
        })) {}
  WorkerThread(const WorkerThread&) = delete;
  WorkerThread& operator=(const WorkerThread&) = delete;
  ~WorkerThread() {
    if (thread_.joinable()) thread_.join();
  }

  void join() {
    if (thread_.joinable()) thread_.join();
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  }

 private:
  template <class Work>
  static std::thread started(Work&& work) {
    try {
      return std::thread(std::forward<Work>(work));
    } catch (const std::system_error& error) {
      throw InputError("a thread cannot be started: " + error.code().message() +
                       "; expected room for a few threads on this machine");
    }
  }

  std::exception_ptr error_;
  std::thread thread_;  // last: it starts when everything above is ready
};

// The first stage of a chain: sends what `next` gives until it gives nothing or the channel closes,
// then closes `out`, and so if `next` throws, which comes out of join(). The destructor closes it
// too.
template <class Out>
class SourceThread {
 public:
  SourceThread(Channel<Out>& out, std::function<std::optional<Out>()> next)
      : out_(out), worker_([&out, next = std::move(next)] {
          const ChannelCloser closer{out};
          while (std::optional<Out> message = next()) {
            if (!out.send(std::move(*message))) return;
          }
        }) {}

  SourceThread(const SourceThread&) = delete;
  SourceThread& operator=(const SourceThread&) = delete;
  ~SourceThread() { out_.close(); }

  void join() { worker_.join(); }

 private:
  struct ChannelCloser {
    Channel<Out>& out;
    ~ChannelCloser() { out.close(); }
  };

  Channel<Out>& out_;
  WorkerThread worker_;
};

// Runs a single-threaded stage between two channels: out = stage(in) until `in` is closed, then
// closes `out`. If the stage throws, both channels are closed, so that its neighbours end too, and
// join() throws what the stage threw. The destructor closes both channels as well: an exception
// that unwinds the owner must not wait for messages that are never sent.
template <class In, class Out>
class StageThread {
 public:
  StageThread(Channel<In>& in, Channel<Out>& out, std::function<Out(In)> stage)
      : in_(in), out_(out), worker_([&in, &out, stage = std::move(stage)] {
          const ChannelCloser closer{in, out};
          while (std::optional<In> message = in.receive()) {
            if (!out.send(stage(std::move(*message)))) return;
          }
        }) {}

  StageThread(const StageThread&) = delete;
  StageThread& operator=(const StageThread&) = delete;
  ~StageThread() {
    in_.close();
    out_.close();
  }

  void join() { worker_.join(); }

 private:
  struct ChannelCloser {
    Channel<In>& in;
    Channel<Out>& out;
    ~ChannelCloser() {
      in.close();
      out.close();
    }
  };

  Channel<In>& in_;
  Channel<Out>& out_;
  WorkerThread worker_;
};

}  // namespace samewhere::core
