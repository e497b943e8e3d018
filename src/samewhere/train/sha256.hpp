#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace samewhere::train {

// SHA-256 of bytes given piece by piece (libcrypto's).
class Sha256 {
 public:
  Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;
  ~Sha256();

  void add(std::string_view bytes);
  // 64 hexadecimal digits, as sha256sum prints them. To be asked for once.
  std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::string sha256_of(std::string_view bytes);

}  // namespace samewhere::train
