#include <array>

#include <fmt/format.h>
#include <openssl/evp.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/train/sha256.hpp>

namespace samewhere::train {

struct Sha256::State {
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context{EVP_MD_CTX_new(),
                                                                  &EVP_MD_CTX_free};
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  core::require(EVP_DigestInit_ex(state_->context.get(), EVP_sha256(), nullptr) == 1,
                "libcrypto has SHA-256");
}

Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  core::require(EVP_DigestUpdate(state_->context.get(), bytes.data(), bytes.size()) == 1,
                "SHA-256 takes any bytes before it is asked for its digits");
}

std::string Sha256::hex() {
  std::array<unsigned char, 32> digest{};
  core::require(EVP_DigestFinal_ex(state_->context.get(), digest.data(), nullptr) == 1,
                "SHA-256 is asked for its digits once");
  std::string text;
  for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

std::string sha256_of(std::string_view bytes) {
  Sha256 sha;
  sha.add(bytes);
  return sha.hex();
}

}  // namespace samewhere::train
