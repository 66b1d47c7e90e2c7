// SPDX-License-Identifier: Apache-2.0
#include "texgen/export/export_mesh.h"

#include <iterator>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "texgen/export/blade_mesh.h"
#include "texgen/export/glb.h"
#include "texgen/support/parallel.h"
#include "texgen/support/step_timer.h"

namespace sward::texgen {
namespace {

using nlohmann::ordered_json;

constexpr std::uint64_t kBytesOfBlade =
    3000; // at most, in all levels: 27 vertices and their triangles
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;
/// Share of the screen's height above which a level is drawn, for readers of MSFT_lod.
constexpr double kScreenShares[] = {0.5, 0.2, 0.02};

struct Task {
    int level = 0, variant = 0, species = 0;
    BladeMesh mesh;
};

std::vector<Task> make_meshes(const grass::GrassSet& set, int levels, int threads) {
    std::vector<Task> tasks;
    for (int level = 0; level < levels; ++level)
        for (int v = 0; v < set.variants; ++v)
            for (int s = 0; s < static_cast<int>(set.species.size()); ++s)
                tasks.push_back({level, v, s, {}});
    base::Progress progress("blade meshes", tasks.size());
    parallel_for(tasks.size(), resolve_threads(threads), [&](std::size_t i, int) {
        Task& task = tasks[i];
        const auto v = static_cast<std::size_t>(task.variant);
        const auto blades =
            std::span(set.blades)
                .subspan(set.variant_begin[v], set.variant_begin[v + 1] - set.variant_begin[v]);
        task.mesh = blade_mesh(blades, task.species,
                               set.species[static_cast<std::size_t>(task.species)].look,
                               kMeshLods[task.level]);
        progress.advance();
    });
    return tasks;
}

ordered_json material(const grass::Species& species) {
    const shared::GrassAppearance& look = species.look;
    return {{"name", species.name},
            {"doubleSided", true},
            {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}},
            {"extras",
             {{"kd", look.gloss.diffuse},
              {"pd", look.gloss.diffuse_power},
              {"ks", look.gloss.specular},
              {"ps", look.gloss.specular_power},
              {"translucency", look.translucency}}}};
}

/// Adds a mesh and a node for it; returns the node.
std::size_t add_mesh(GlbWriter& glb, const Task& task, const std::string& species) {
    const BladeMesh& m = task.mesh;
    ordered_json attributes = {
        {"POSITION", glb.add_floats(m.positions, 3, true)},
        {"NORMAL", glb.add_floats(m.normals, 3)},
        {"TEXCOORD_0", glb.add_floats(m.uvs, 2)},
        {"TEXCOORD_1", glb.add_floats(m.wind_uvs, 2)},
        {"COLOR_0", glb.add_unorm16(m.colours)},
        {"_BLADE",
         glb.add_floats(m.blades,
                        3)}, // of one shape and type: Blender's importer takes one for another
        {"_ROOT", glb.add_floats(m.roots, 3)},
        {"_WIND", glb.add_floats(m.winds, 3)}};
    const std::string name = fmt::format("variant{}_{}_LOD{}", task.variant, species, task.level);
    glb.root["meshes"].push_back({{"name", name},
                                  {"primitives",
                                   {{{"attributes", attributes},
                                     {"indices", glb.add_indices(m.indices, m.vertices())},
                                     {"material", task.species}}}}});
    glb.root["nodes"].push_back({{"name", name}, {"mesh", glb.root["meshes"].size() - 1}});
    return glb.root["nodes"].size() - 1;
}

/// A node a variant with its species' below; returns it.
std::size_t add_variant(GlbWriter& glb, const grass::GrassSet& set, std::span<const Task> tasks) {
    ordered_json children = ordered_json::array();
    for (const Task& task : tasks)
        if (task.mesh.vertices() > 0)
            children.push_back(
                add_mesh(glb, task, set.species[static_cast<std::size_t>(task.species)].name));
    ordered_json node = {
        {"name", fmt::format("variant{}_LOD{}", tasks[0].variant, tasks[0].level)}};
    if (!children.empty())
        node["children"] = children;
    if (tasks[0].variant > 0) // side by side, as in blades.glb
        node["translation"] = {static_cast<double>(tasks[0].variant) * set.side_m, 0, 0};
    glb.root["nodes"].push_back(node);
    return glb.root["nodes"].size() - 1;
}

void link_levels(GlbWriter& glb, int variants, int levels) {
    glb.root["extensionsUsed"] = {"MSFT_lod"};
    for (int v = 0; v < variants; ++v) {
        const auto root_of = [&](int level) {
            return glb.root["scenes"][static_cast<std::size_t>(level)]["nodes"]
                           [static_cast<std::size_t>(v)];
        };
        ordered_json ids = ordered_json::array(), shares = ordered_json::array();
        for (int level = 0; level < levels; ++level) {
            if (level > 0)
                ids.push_back(root_of(level));
            shares.push_back(kScreenShares[level]);
        }
        ordered_json& node = glb.root["nodes"][root_of(0).get<std::size_t>()];
        node["extensions"]["MSFT_lod"]["ids"] = ids;
        node["extras"]["MSFT_screencoverage"] = shares;
    }
}

ordered_json facts(const grass::GrassSet& set, int levels) {
    ordered_json lods = ordered_json::array();
    for (int level = 0; level < levels; ++level)
        lods.push_back({{"share", kMeshLods[level].share},
                        {"segments", kMeshLods[level].segments},
                        {"head_segments", kMeshLods[level].head_segments}});
    return {
        {"preset", set.name},
        {"seed", set.seed},
        {"side_m", set.side_m},
        {"canopy_m", set.canopy_m},
        {"variants", set.variants},
        {"lods", lods},
        {"_WIND", "how far the wind moves the vertex, 0 root .. 1 tip; phase 0..1; stiffness 0..1"},
        {"_ROOT", "root of the blade, metres"},
        {"_BLADE", "rank 0..1, seed 0..1, length in metres"}};
}

} // namespace

std::vector<std::byte> encode_blade_meshes(const grass::GrassSet& set, int levels, int threads) {
    const StepTimer timer("blade meshes");
    if (set.blades.size() * kBytesOfBlade > kMostBytes)
        throw base::Error(base::ExitCode::kOverLimit,
                          fmt::format("{}: found {} blades, expected at most {} as triangles",
                                      set.name, set.blades.size(), kMostBytes / kBytesOfBlade));
    const std::vector<Task> tasks = make_meshes(set, levels, threads);
    GlbWriter glb;
    glb.root["asset"]["extras"] = facts(set, levels);
    glb.root["scene"] = 0;
    for (const grass::Species& species : set.species)
        glb.root["materials"].push_back(material(species));
    const std::size_t species = set.species.size(),
                      variants = static_cast<std::size_t>(set.variants);
    for (std::size_t level = 0; level < static_cast<std::size_t>(levels); ++level) {
        ordered_json nodes = ordered_json::array();
        for (std::size_t v = 0; v < variants; ++v)
            nodes.push_back(add_variant(
                glb, set, std::span(tasks).subspan((level * variants + v) * species, species)));
        glb.root["scenes"].push_back({{"name", fmt::format("LOD{}", level)}, {"nodes", nodes}});
    }
    if (levels > 1)
        link_levels(glb, set.variants, levels);
    return glb.finish();
}

} // namespace sward::texgen
