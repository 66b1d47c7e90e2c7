// SPDX-License-Identifier: Apache-2.0
// What every GL test stands on: a context whose debug messages are failures, a copy of the shaders
// to meddle with, and frame constants made without the renderer.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "gl/buffer.h"
#include "gl/context.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "gl/synthetic.h"
#include "shared/bindings.h"
#include "shared/frame.h"
#include "terrain/clipmap.h"
#include "wind/wind.h"

namespace sward::tests {

class GlTest : public testing::Test {
protected:
    GlTest() : context_(true) { gl::watch_debug_messages(&messages_); }
    void TearDown() override {
        glFinish();
        EXPECT_EQ(messages_.count, 0) << messages_.first;
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    }
    /// For tests that provoke the driver on purpose.
    void forgive_messages() {
        messages_ = {};
        while (glGetError() != GL_NO_ERROR) {
        }
    }

private:
    gl::HeadlessContext context_;
    gl::DebugMessages messages_;
};

/// A copy of the shaders in a temporary directory that programs are read from while it lives.
class ShaderCopy {
public:
    ShaderCopy() {
        std::string name =
            (std::filesystem::temp_directory_path() / "sward_shaders_XXXXXX").string();
        path_ = ::mkdtemp(name.data());
        std::filesystem::copy(original_, path_, std::filesystem::copy_options::recursive);
        ::setenv("SWARD_SHADERS", path_.c_str(), 1);
    }
    ~ShaderCopy() {
        ::setenv("SWARD_SHADERS", original_.c_str(), 1);
        std::filesystem::remove_all(path_);
    }
    ShaderCopy(const ShaderCopy&) = delete;
    ShaderCopy& operator=(const ShaderCopy&) = delete;

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name) << text;
    }
    /// Adds lines to a file; returns the number of the first.
    int append(const std::string& name, const std::string& text) const {
        std::ifstream in(path_ / name);
        int lines = 0;
        for (std::string line; std::getline(in, line);) {
            ++lines;
        }
        std::ofstream(path_ / name, std::ios::app) << text;
        return lines + 1;
    }
    void restore(const std::string& name) const {
        std::filesystem::copy_file(original_ / name, path_ / name,
                                   std::filesystem::copy_options::overwrite_existing);
    }

private:
    std::filesystem::path original_ = gl::shader_directory();
    std::filesystem::path path_;
};

/// Runs `body` on the GPU once an input: it reads vec4 `a` and writes vec4 `b`, with `includes`
/// before it.
inline std::vector<glm::vec4> run_probe(const ShaderCopy& shaders,
                                        const std::vector<std::string>& includes,
                                        const std::string& body,
                                        const std::vector<glm::vec4>& inputs) {
    std::string text;
    for (const std::string& include : includes) {
        text += "#include \"" + include + "\"\n";
    }
    text += "layout(local_size_x = 64) in;\n"
            "layout(std430, binding = 6) readonly buffer ProbeIn { vec4 probe_in[]; };\n"
            "layout(std430, binding = 7) writeonly buffer ProbeOut { vec4 probe_out[]; };\n"
            "void main() {\n    uint i = gl_GlobalInvocationID.x;\n    if (i >= "
            "uint(probe_in.length())) { return; }\n"
            "    vec4 a = probe_in[i];\n    vec4 b = vec4(0.0);\n" +
            body + "\n    probe_out[i] = b;\n}\n";
    shaders.write("probe.comp", text);
    const gl::Program program("probe", {"probe.comp"});
    const auto in = gl::Buffer::of(std::span<const glm::vec4>(inputs));
    const gl::Buffer out(inputs.size() * sizeof(glm::vec4));
    in.bind_storage(6);
    out.bind_storage(7);
    program.use();
    glDispatchCompute(static_cast<GLuint>((inputs.size() + 63) / 64), 1, 1);
    return out.read_all<glm::vec4>(inputs.size());
}

/// Looks north from an anchor-relative eye, 90 degrees each way.
inline glm::mat4 wide_view(glm::vec3 eye) {
    glm::mat4 projection(0);
    projection[0][0] = projection[1][1] = 1;
    projection[2][3] = -1;
    projection[3][2] = shared::kNear_m;
    glm::mat4 view(1);
    view[3] = glm::vec4(-eye, 1);
    return projection * view;
}

/// A small world on the GPU: ground, wind and grass, an eye over them, and constants for both.
struct SmallWorld {
    SmallWorld(scene::Heightfield field, double relief_m, scene::DensityMask mask_in,
               glm::dvec3 eye_at)
        : surface(std::move(field), relief_m), mask(std::move(mask_in)), clipmap(surface, mask),
          wind(breeze(), 0.1), set(synthetic_set()) {
        clipmap.update({eye_at.x, eye_at.z});
        clipmap.bind();
        anchor = {std::round(eye_at.x / 64) * 64, std::floor(eye_at.y),
                  std::round(eye_at.z / 64) * 64};
        const glm::vec3 eye(eye_at - anchor);
        frame.clip_from_world = wide_view(eye);
        frame.near_m = shared::kNear_m;
        frame.world_from_clip = glm::inverse(frame.clip_from_world);
        frame.eye = frame.lod_eye = eye;
        frame.focal_px = 400, frame.flutter_time = 0.25f;
        const glm::dvec2 flat(anchor.x, anchor.z),
            tile = glm::floor(flat / static_cast<double>(set.side_m));
        frame.patch_offset_m = glm::vec2(flat - tile * static_cast<double>(set.side_m));
        frame.patch_side_m = set.side_m;
        frame.canopy_m = set.canopy_m;
        frame.anchor_tile = glm::ivec2(tile);
        frame.patch_variants = set.variants;
        frame.far_levels = static_cast<int>(set.levels.size());
        frame.offset_range_m = set.offset_range_m;
        frame.density_scale = frame.ground_takes_over = 1;
        frame.anchor_height_m = static_cast<float>(anchor.y);
        frame.handover_mode = shared::kHandoverRank, frame.forced_level = -1;
        frame.handover_band = frame.pose_band = {4, 9};
        frame.width_least_px = 0.1f, frame.width_span_px = 0.35f;
        frame.segment_px = 12, frame.blade_width_m = 0.006f;
        clipmap.describe(frame, flat);
        frame.looks[0] = set.species.front().look;
        frame.light = daylight(glm::normalize(glm::vec3(0.4f, 0.7f, 0.3f)));
        wind.advance(kTime_s, {eye_at.x, eye_at.z});
        wind.wait();
        wind.bind();
        frame.wind = wind.field(flat, kTime_s);
        upload();
    }
    static scene::WindSpec breeze() {
        scene::WindSpec spec;
        spec.speed_mps = 5;
        spec.gust = 0.6;
        return spec;
    }
    /// After a change of `frame`.
    void upload() {
        if (!frame_buffer.id()) {
            frame_buffer = gl::Buffer(sizeof(frame));
        }
        frame_buffer.upload(&frame, sizeof(frame));
        frame_buffer.bind_uniform(BIND_FRAME);
    }
    /// World metres of an anchor-relative place.
    [[nodiscard]] glm::dvec2 world(glm::vec2 place) const {
        return glm::dvec2(place) + glm::dvec2(anchor.x, anchor.z);
    }

    /// The wind's C++ twin at an anchor-relative place.
    [[nodiscard]] glm::vec2 wind_at(glm::vec2 place) const {
        const glm::dvec2 at = world(place);
        return glm::vec2(wind.at(at.x, at.y, kTime_s));
    }

    static constexpr double kTime_s = 12.5;
    terrain::Surface surface;
    scene::DensityMask mask;
    terrain::Clipmap clipmap;
    wind::Wind wind;
    grass::GrassSet set;
    glm::dvec3 anchor{0};
    shared::FrameConstants frame{};
    gl::Buffer frame_buffer;
};

} // namespace sward::tests
