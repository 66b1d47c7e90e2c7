// SPDX-License-Identifier: Apache-2.0
#include "assets/gltf_file.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;
using nlohmann::json;
using Bytes = std::vector<std::byte>;
/// Buffers by their URI, as tinygltf will ask for them (percent signs decoded).
using Buffers = std::map<std::string, Bytes>;

constexpr std::uint64_t kMostBytes = std::uint64_t{512}
                                     << 20; // of the glTF itself, its binary chunk included
constexpr std::uint64_t kMostBuffer = std::uint64_t{256} << 20;   // of an external buffer
constexpr std::uint64_t kMostBuffers = std::uint64_t{1024} << 20; // of all of them
constexpr std::size_t kMostJson = std::size_t{64} << 20;
constexpr int kMostDepth = 64;
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A;

class GltfReader {
public:
    explicit GltfReader(const fs::path& path)
        : path_(path), bytes_(base::read_file(path, kMostBytes)) {}

    tinygltf::Model read() {
        const std::string_view text = json_text();
        check_depth(text);
        check_document(text);
        return parse(text);
    }

private:
    [[noreturn]] void refuse(std::string_view what, const std::string& found,
                             const std::string& expected,
                             ExitCode code = ExitCode::kBadInput) const {
        throw base::input_error(code, path_, 0, what, found, expected);
    }

    /// The JSON of either form. Lengths of a GLB are checked here, before tinygltf trusts them.
    std::string_view json_text() {
        const char* const data = reinterpret_cast<const char*>(bytes_.data());
        std::uint32_t head[5] = {};
        std::memcpy(head, bytes_.data(), std::min(bytes_.size(), sizeof head));
        binary_ = bytes_.size() >= 4 && head[0] == kMagic;
        std::string_view text(data, bytes_.size());
        if (binary_) {
            if (bytes_.size() < sizeof head || head[1] != 2 || head[2] != bytes_.size() ||
                head[4] != kJsonChunk || head[3] > bytes_.size() - sizeof head)
                refuse("header", fmt::format("{} bytes that do not fit it", bytes_.size()),
                       "binary glTF 2.0, whole");
            text = text.substr(sizeof head, head[3]);
        }
        if (text.size() > kMostJson)
            refuse("JSON", fmt::format("{} bytes", text.size()),
                   fmt::format("at most {}", kMostJson), ExitCode::kOverLimit);
        if (text.empty())
            refuse("file", "no JSON", "glTF 2.0");
        return text;
    }

    /// Brackets in strings count too, which only makes it stricter.
    void check_depth(std::string_view text) const {
        int depth = 0;
        for (const char c : text) {
            depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
            if (depth > kMostDepth)
                refuse("JSON", "deeper nesting", fmt::format("at most {} levels", kMostDepth),
                       ExitCode::kOverLimit);
        }
    }

    /// What must hold before tinygltf acts on it: no extension that we lack, buffers that may be
    /// read.
    void check_document(std::string_view text) {
        const json document = json::parse(text, nullptr, false);
        if (!document.is_object())
            refuse("file", "no JSON object", "glTF 2.0");
        check_version(document);
        if (const auto required = document.find("extensionsRequired");
            required != document.end() && !required->empty())
            refuse("extensionsRequired",
                   base::printable(required->dump(-1, ' ', true, json::error_handler_t::replace)),
                   "none (no extension is read, Draco, meshopt and KTX2 included)");
        const auto buffers = document.find("buffers");
        if (buffers == document.end() || !buffers->is_array())
            return; // tinygltf or the mesh reader says what is missing
        std::uint64_t sum = 0;
        for (const json& buffer : *buffers) {
            const auto uri = buffer.is_object() ? buffer.find("uri") : buffer.end();
            if (!binary_ && buffer.is_object() && uri == buffer.end())
                refuse("buffer's URI", "none", "a file beside the glTF, or data");
            if (!buffer.is_object() || uri == buffer.end() || !uri->is_string())
                continue; // the binary chunk
            const auto name = uri->get<std::string>();
            if (name.starts_with("data:")) {
                check_data(name);
                continue; // as long as the text that holds it
            }
            const std::string decoded = decode(name);
            if (buffers_.contains(decoded))
                continue;
            Bytes data = read_buffer(decoded);
            sum += data.size();
            if (sum > kMostBuffers)
                refuse("buffers", fmt::format("{} bytes", sum),
                       fmt::format("at most {}", kMostBuffers), ExitCode::kOverLimit);
            buffers_.emplace(decoded, std::move(data));
        }
    }

    void check_version(const json& document) const {
        const auto asset = document.find("asset");
        if (asset == document.end() || !asset->is_object() || !asset->contains("version"))
            return; // tinygltf says so
        const json& version = (*asset)["version"];
        if (!version.is_string() || !version.get<std::string>().starts_with("2."))
            refuse("asset.version",
                   base::printable(version.dump(-1, ' ', true, json::error_handler_t::replace)),
                   "\"2.0\"");
    }

    void check_data(const std::string& uri) const {
        for (const char* kind :
             {"data:application/octet-stream;base64,", "data:application/gltf-buffer;base64,"})
            if (uri.starts_with(kind))
                return;
        refuse("buffer's URI", base::printable(uri, 60),
               "data:application/octet-stream;base64,...");
    }

    Bytes read_buffer(const std::string& name) const {
        const fs::path file = local_file(name);
        try {
            return base::read_file(file, kMostBuffer);
        } catch (const base::Error& error) {
            throw base::Error(
                error.code(),
                fmt::format("{}: buffer {}", base::printable(path_.native(), 1024), error.what()));
        }
    }

    std::string decode(const std::string& uri) const {
        std::string out;
        for (std::size_t i = 0; i < uri.size(); ++i) {
            if (uri[i] != '%') {
                out += uri[i];
                continue;
            }
            const auto hex = [&](std::size_t at) -> int {
                const char c = at < uri.size() ? uri[at] : '\0';
                return c >= '0' && c <= '9'   ? c - '0'
                       : c >= 'a' && c <= 'f' ? c - 'a' + 10
                       : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                              : -1;
            };
            const int high = hex(i + 1), low = hex(i + 2);
            if (high < 0 || low < 0)
                refuse("buffer's URI", base::printable(uri), "%XX");
            out += static_cast<char>(high * 16 + low);
            i += 2;
        }
        return out;
    }

    /// The file that a URI names, if it may be read.
    fs::path local_file(const std::string& uri) const {
        const auto reject = [&](const char* expected) {
            refuse("buffer's URI", uri.empty() ? "\"\"" : base::printable(uri), expected);
        };
        if (uri.empty() || uri.size() > 1024 || uri.find('\0') != std::string::npos ||
            uri.find('\\') != std::string::npos)
            reject("the name of a file");
        if (uri.find(':') != std::string::npos || uri.front() == '/')
            reject("a file beside the glTF, without a scheme or root");
        fs::path at = path_.parent_path();
        for (const fs::path& part : fs::path(uri)) {
            if (part == "..")
                reject("a file beside the glTF or below it");
            at /= part;
            std::error_code ignored;
            if (fs::is_symlink(fs::symlink_status(at, ignored)))
                reject("a file, not a symbolic link");
        }
        return at;
    }

    tinygltf::TinyGLTF loader() {
        tinygltf::TinyGLTF loader;
        tinygltf::FsCallbacks calls{};
        calls.user_data = &buffers_;
        calls.FileExists = [](const std::string& name, void* buffers) {
            return static_cast<const Buffers*>(buffers)->contains(name);
        };
        calls.ExpandFilePath = [](const std::string& name, void*) { return name; };
        calls.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error,
                                 const std::string& name, void* buffers) {
            const auto found = static_cast<const Buffers*>(buffers)->find(name);
            if (found == static_cast<const Buffers*>(buffers)->end()) {
                *error = "no such buffer";
                return false;
            }
            const auto* data = reinterpret_cast<const unsigned char*>(found->second.data());
            out->assign(data, data + found->second.size());
            return true;
        };
        calls.WriteWholeFile = [](std::string*, const std::string&,
                                  const std::vector<unsigned char>&, void*) { return false; };
        loader.SetFsCallbacks(calls);
        // Pictures are somebody else's: a bomb among them is never unpacked.
        loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                                 const unsigned char*, int, void*) { return true; },
                              nullptr);
        return loader;
    }

    tinygltf::Model parse(std::string_view text) {
        tinygltf::Model model;
        std::string error, warning;
        bool loaded = false;
        try {
            tinygltf::TinyGLTF gltf = loader();
            loaded = binary_ ? gltf.LoadBinaryFromMemory(
                                   &model, &error, &warning,
                                   reinterpret_cast<const unsigned char*>(bytes_.data()),
                                   static_cast<unsigned int>(bytes_.size()))
                             : gltf.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                                        static_cast<unsigned int>(text.size()), "");
        } catch (const std::exception& problem) { // its JSON library throws
            error = problem.what();
        }
        if (!loaded) {
            std::replace(error.begin(), error.end(), '\n', ' ');
            refuse("glTF", error.empty() ? "no reason given" : base::printable(error, 160),
                   "glTF 2.0");
        }
        return model;
    }

    const fs::path& path_;
    Bytes bytes_;
    Buffers buffers_;
    bool binary_ = false;
};

} // namespace

tinygltf::Model read_gltf(const fs::path& path) {
    return GltfReader(path).read();
}

} // namespace sward::assets
