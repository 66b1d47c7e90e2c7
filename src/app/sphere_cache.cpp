// SPDX-License-Identifier: Apache-2.0
#include "app/sphere_cache.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "app/paths.h"
#include "assets/sphere_packing.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"

namespace sward::app {
namespace {

namespace fs = std::filesystem;

constexpr int kPackingVersion = 1; // another one where the same mesh would be packed otherwise
constexpr std::size_t kHashLength = 64;
constexpr std::uint64_t kFileLimit = std::uint64_t{1} << 20; // 10,000 balls are 160 KB

template<class T> std::string hash_of(const std::vector<T>& items) {
    return base::sha256_hex(std::as_bytes(std::span(items)));
}

std::string key_of(const scene::Mesh& mesh, const assets::PackingSettings& settings) {
    return base::sha256_hex(fmt::format("{} {} {} {} {}", kPackingVersion, settings.most_spheres,
                                        settings.cells, hash_of(mesh.positions),
                                        hash_of(mesh.triangles)));
}

/// The balls of a file: their SHA-256 in hexadecimal, then four floats each. Nothing where there is
/// no such file, or a damaged one.
std::optional<scene::SphereSet> read_cached(const fs::path& file) {
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(file, ignored)))
        return {};
    try {
        const std::vector<std::byte> bytes = base::read_file(file, kFileLimit);
        if (bytes.size() > kHashLength && (bytes.size() - kHashLength) % sizeof(glm::vec4) == 0) {
            scene::SphereSet set;
            set.spheres.resize((bytes.size() - kHashLength) / sizeof(glm::vec4));
            std::memcpy(set.spheres.data(), bytes.data() + kHashLength, bytes.size() - kHashLength);
            const std::string hash(reinterpret_cast<const char*>(bytes.data()), kHashLength);
            if (hash == hash_of(set.spheres))
                return set;
        }
    } catch (const base::Error& error) {
        base::log_debug(error.what());
    }
    base::log_warning(fmt::format("the cached spheres {} cannot be used: the mesh is packed again",
                                  base::printable(file.native(), 200)));
    return {};
}

void write_cached(const fs::path& file, const scene::SphereSet& set) {
    std::string text = hash_of(set.spheres);
    const auto bytes = std::as_bytes(std::span(set.spheres));
    text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    try {
        fs::create_directories(file.parent_path());
        base::write_file_atomic(file, text);
    } catch (const std::exception& error) {
        base::log_warning(fmt::format("the spheres of a mesh are not kept: {}",
                                      base::printable(error.what(), 300)));
    }
}

scene::SphereSet packed(const fs::path& name, const scene::Mesh& mesh,
                        const assets::PackingSettings& settings) {
    const fs::path file = sphere_cache_directory() / (key_of(mesh, settings) + ".balls");
    if (auto cached = read_cached(file))
        return std::move(*cached);
    scene::SphereSet set = assets::pack_spheres(mesh, settings, name);
    base::log_info(fmt::format("{}: packed with {} spheres on first use",
                               base::printable(name.native(), 200), set.spheres.size()));
    write_cached(file, set);
    return set;
}

} // namespace

std::map<fs::path, scene::SphereSet> load_spheres(const scene::Scene& scene,
                                                  const std::map<fs::path, scene::Mesh>& meshes) {
    std::map<fs::path, int> most;
    for (const scene::ObjectSpec& object : scene.objects)
        if (object.collides && !object.mesh.empty())
            most[object.mesh] = std::max(most[object.mesh], object.most_spheres);
    std::map<fs::path, scene::SphereSet> sets;
    for (const auto& [name, count] : most) {
        assets::PackingSettings settings;
        settings.most_spheres = count;
        sets.emplace(name, packed(name, meshes.at(name), settings));
    }
    return sets;
}

} // namespace sward::app
