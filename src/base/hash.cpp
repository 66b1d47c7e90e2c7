// SPDX-License-Identifier: Apache-2.0
#include "base/hash.h"

#include <array>
#include <iterator>

#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/sha.h>

#include "base/error.h"

namespace sward::base {
namespace {

/// Finaliser with full avalanche: each input bit flips each output bit with probability one half
/// (Stafford's mix 13).
std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

constexpr std::uint64_t kGolden =
    0x9e3779b97f4a7c15ull; // 2^64 / golden ratio: keeps small counters far apart

} // namespace

std::string sha256_hex(std::span<const std::byte> bytes) {
    std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
    if (!EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr, EVP_sha256(), nullptr)) {
        throw Error(ExitCode::kFailure, "SHA-256: the cryptographic library refused");
    }
    std::string hex;
    for (const unsigned char byte : digest) {
        fmt::format_to(std::back_inserter(hex), "{:02x}", byte);
    }
    return hex;
}

std::string sha256_hex(const std::string& text) {
    return sha256_hex(std::as_bytes(std::span(text.data(), text.size())));
}

std::uint64_t hash64(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
    std::uint64_t x = mix(seed + kGolden);
    x = mix(x + kGolden * (stream + 1));
    return mix(x + kGolden * (index + 1));
}

double hash_unit(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
    return static_cast<double>(hash64(seed, stream, index) >> 11) * 0x1.0p-53;
}

} // namespace sward::base
