// SPDX-License-Identifier: Apache-2.0
#include "app/set_cache.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <functional>
#include <optional>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "app/child_process.h"
#include "app/commands.h"
#include "app/paths.h"
#include "app/set_lookup.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"
#include "grass/set_files.h"

namespace sward::app {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

constexpr std::uint64_t kPresetLimit = std::uint64_t{1} << 20;
constexpr std::uint64_t kProgramLimit = std::uint64_t{1} << 30, kNoteLimit = 256;

/// One baker at a time: a second process waits and then finds the set. Held until the end of the
/// scope.
class CacheLock {
public:
    explicit CacheLock(const fs::path& path)
        : fd_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666)) {
        if (fd_ < 0)
            throw base::input_error(ExitCode::kIo, path, 0, "cannot lock the cache",
                                    std::strerror(errno),
                                    "a writable directory (XDG_CACHE_HOME names another)");
        if (::flock(fd_, LOCK_EX | LOCK_NB) == 0)
            return;
        base::log_info("grass set: waiting for another process that bakes it");
        while (::flock(fd_, LOCK_EX) != 0 && errno == EINTR) {
        } // a file system without locks: two bakers then do the work twice, and one wins
    }
    ~CacheLock() { ::close(fd_); }
    CacheLock(const CacheLock&) = delete;
    CacheLock& operator=(const CacheLock&) = delete;

private:
    int fd_;
};

/// The texgen beside us, by its content: clocks may be wrong. Empty where it cannot be read; baking
/// will say why.
std::string baker() {
    try {
        return base::sha256_hex(base::read_file(texgen_program(), kProgramLimit));
    } catch (const base::Error&) {
        return {};
    }
}

/// Where the cache notes which texgen baked a set.
fs::path baker_note(const fs::path& set) {
    return fs::path(set) += ".texgen";
}

/// Baked by another texgen than the one beside us: its picture may differ from a cold start's.
bool is_outdated(const fs::path& set) {
    try {
        return base::read_text(baker_note(set), kNoteLimit) != baker();
    } catch (const base::Error&) {
        return true;
    }
}

/// Whether a preset sets anything: a line with a key.
bool sets_nothing(const std::string& text) {
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string line = text.substr(at, end - at);
        const std::size_t equals = line.find('=');
        if (equals != std::string::npos && equals < line.find('#'))
            return false;
        at = end + 1;
    }
    return true;
}

std::string reason_of(const base::Error& error) {
    return base::printable(error.what(), 300);
}

/// "PART: 30 %", as texgen tells of its progress where no terminal listens.
std::optional<double> share_of(std::string_view line, std::string_view* part) {
    const std::size_t colon = line.rfind(": ");
    int percent = 0;
    if (colon == std::string_view::npos || !line.ends_with(" %") ||
        std::from_chars(line.data() + colon + 2, line.data() + line.size() - 2, percent).ec !=
            std::errc())
        return {};
    *part = line.substr(0, colon);
    return std::clamp(percent / 100.0, 0.0, 1.0);
}

void bake(const fs::path& preset, const fs::path& set, const LoadTold& told) {
    base::log_info(fmt::format("grass set of {}: baked on first use, into {}",
                               base::printable(preset.native(), 200), set.native()));
    std::vector<std::string> arguments = {fs::absolute(preset).string(), "-o", set.string(),
                                          "--no-preview", "--no-volume"};
    if (base::verbosity() == base::Verbosity::kQuiet)
        arguments.emplace_back("-q");
    std::function<void(std::string_view)> listen;
    if (told) {
        const std::string what = fmt::format("baking the grass set of {}",
                                             base::printable(preset.filename().native(), 100));
        told(what, {});
        listen = [what, &told](std::string_view line) {
            std::string_view part;
            if (const auto share = share_of(line, &part))
                told(fmt::format("{}: {}", what, base::printable(part, 100)), share);
        };
    }
    if (const int code = run_program(texgen_program(), arguments, listen); code != 0)
        throw AlreadyReported{code};
}

fs::path prepare_cache() {
    const fs::path cache = set_cache_directory();
    std::error_code error;
    fs::create_directories(cache, error);
    if (error)
        throw base::input_error(ExitCode::kIo, cache, 0, "cannot make the cache of grass sets",
                                error.message(),
                                "a writable directory (XDG_CACHE_HOME names another)");
    return cache;
}

/// The cached set, or nothing where it has to be baked. `complain`: say why once it is certain.
std::optional<grass::GrassSet> read_cached(const fs::path& set, bool complain) {
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(set, ignored)) || is_outdated(set))
        return {};
    try {
        return grass::read_grass_set(set);
    } catch (const base::Error& error) {
        if (complain)
            base::log_warning(fmt::format(
                "the cached grass set cannot be used and is baked again: {}", reason_of(error)));
        return {};
    }
}

} // namespace

grass::GrassSet load_grass(const scene::Scene& scene, const LoadTold& told) {
    const SetPlace place = find_set(scene);
    if (told)
        told("grass set", {});
    if (!place.is_preset)
        return grass::read_grass_set(place.path);
    const std::string text = base::read_text(place.path, kPresetLimit);
    const fs::path cache = prepare_cache();
    const std::string key = base::sha256_hex(fmt::format("{}\n{}", grass::kSetFormatVersion, text));
    const fs::path set = cache / key;
    if (auto cached = read_cached(set, false))
        return std::move(*cached);

    if (told)
        told("grass set: waiting for the cache", {});
    const CacheLock lock(cache / (key + ".lock"));
    if (auto cached = read_cached(set, true)) // another process may have baked it while we waited
        return std::move(*cached);
    std::error_code ignored;
    if (sets_nothing(text))
        base::log_warning(fmt::format("{}: sets nothing; the default meadow is baked",
                                      base::printable(place.path.native(), 1024)));
    fs::remove(baker_note(set), ignored);
    fs::remove_all(set, ignored); // ours alone, and nothing in it can be trusted
    bake(place.path, set, told);
    base::write_file_atomic(baker_note(set), baker());
    return grass::read_grass_set(set);
}

} // namespace sward::app
