// SPDX-License-Identifier: Apache-2.0
#include "gl/state_guard.h"

#include <epoxy/gl.h>

namespace sward::gl {

namespace {

struct Cap {
    GLenum name;
    bool wanted;
};
constexpr std::array<Cap, StateGuard::kCaps> kCapTable = {
    {{GL_DEPTH_TEST, false},
     {GL_CULL_FACE, false},
     {GL_STENCIL_TEST, false},
     {GL_DEPTH_CLAMP, false},
     {GL_POLYGON_OFFSET_FILL, false},
     {GL_POLYGON_OFFSET_LINE, false},
     {GL_POLYGON_OFFSET_POINT, false},
     {GL_POLYGON_SMOOTH, false},
     {GL_COLOR_LOGIC_OP, false},
     {GL_RASTERIZER_DISCARD, false},
     {GL_PRIMITIVE_RESTART, false},
     {GL_PRIMITIVE_RESTART_FIXED_INDEX, false},
     {GL_SAMPLE_ALPHA_TO_COVERAGE, false},
     {GL_SAMPLE_ALPHA_TO_ONE, false},
     {GL_SAMPLE_COVERAGE, false},
     {GL_SAMPLE_MASK, false},
     {GL_SAMPLE_SHADING, false},
     {GL_FRAMEBUFFER_SRGB, false},
     {GL_CLIP_DISTANCE0, false},
     {GL_CLIP_DISTANCE1, false},
     {GL_CLIP_DISTANCE2, false},
     {GL_CLIP_DISTANCE3, false},
     {GL_CLIP_DISTANCE4, false},
     {GL_CLIP_DISTANCE5, false},
     {GL_CLIP_DISTANCE6, false},
     {GL_CLIP_DISTANCE7, false},
     {GL_DITHER, true},
     {GL_MULTISAMPLE, true}}};

constexpr std::array<GLenum, StateGuard::kPixelStores> kPixelStoreTable = {
    GL_UNPACK_SWAP_BYTES,
    GL_UNPACK_LSB_FIRST,
    GL_UNPACK_ROW_LENGTH,
    GL_UNPACK_SKIP_ROWS,
    GL_UNPACK_SKIP_PIXELS,
    GL_UNPACK_IMAGE_HEIGHT,
    GL_UNPACK_SKIP_IMAGES,
    GL_UNPACK_COMPRESSED_BLOCK_WIDTH,
    GL_UNPACK_COMPRESSED_BLOCK_HEIGHT,
    GL_UNPACK_COMPRESSED_BLOCK_DEPTH,
    GL_UNPACK_COMPRESSED_BLOCK_SIZE,
    GL_PACK_SWAP_BYTES,
    GL_PACK_LSB_FIRST,
    GL_PACK_ROW_LENGTH,
    GL_PACK_SKIP_ROWS,
    GL_PACK_SKIP_PIXELS,
    GL_PACK_IMAGE_HEIGHT,
    GL_PACK_SKIP_IMAGES,
    GL_PACK_COMPRESSED_BLOCK_WIDTH,
    GL_PACK_COMPRESSED_BLOCK_HEIGHT,
    GL_PACK_COMPRESSED_BLOCK_DEPTH,
    GL_PACK_COMPRESSED_BLOCK_SIZE,
    GL_UNPACK_ALIGNMENT,
    GL_PACK_ALIGNMENT};
constexpr int kDefaultAlignment = 4; // of the last two; of the others 0

struct Target {
    GLenum target, binding;
};
constexpr std::array<Target, 7> kBufferTable = {
    {{GL_DRAW_INDIRECT_BUFFER, GL_DRAW_INDIRECT_BUFFER_BINDING},
     {GL_DISPATCH_INDIRECT_BUFFER, GL_DISPATCH_INDIRECT_BUFFER_BINDING},
     {GL_PIXEL_PACK_BUFFER, GL_PIXEL_PACK_BUFFER_BINDING},
     {GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_UNPACK_BUFFER_BINDING},
     {GL_QUERY_BUFFER, GL_QUERY_BUFFER_BINDING},
     {GL_UNIFORM_BUFFER, GL_UNIFORM_BUFFER_BINDING},
     {GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING}}};
constexpr std::array<Target, 4> kTextureTable = {
    {{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
     {GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY},
     {GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE},
     {GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER}}};
constexpr std::array<GLenum, 6> kBlendTable = {GL_BLEND_SRC_RGB,      GL_BLEND_DST_RGB,
                                               GL_BLEND_SRC_ALPHA,    GL_BLEND_DST_ALPHA,
                                               GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA};
constexpr std::array<GLenum, 6> kImageTable = {GL_IMAGE_BINDING_NAME,    GL_IMAGE_BINDING_LEVEL,
                                               GL_IMAGE_BINDING_LAYERED, GL_IMAGE_BINDING_LAYER,
                                               GL_IMAGE_BINDING_ACCESS,  GL_IMAGE_BINDING_FORMAT};

void set_switch(GLenum name, bool on) {
    on ? glEnable(name) : glDisable(name);
}
void set_switch_at(GLenum name, GLuint index, bool on) {
    on ? glEnablei(name, index) : glDisablei(name, index);
}

} // namespace

StateGuard::StateGuard() {
    save_switches();
    save_bindings();
    for (const Cap& cap : kCapTable) {
        set_switch(cap.name, cap.wanted);
    }
    for (GLuint i = 0; i < kDrawBuffers; ++i) {
        glDisablei(GL_BLEND, i);
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glBlendEquationi(0, GL_FUNC_ADD);
    glDisablei(GL_SCISSOR_TEST, 0);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDepthRangeIndexed(0, 0, 1);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
    for (const GLenum store : kPixelStoreTable) {
        glPixelStorei(store, store == GL_UNPACK_ALIGNMENT || store == GL_PACK_ALIGNMENT
                                 ? kDefaultAlignment
                                 : 0);
    }
    for (const GLenum target : {GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER, GL_QUERY_BUFFER}) {
        glBindBuffer(target, 0);
    }
    for (GLuint unit = 0; unit < kUnits; ++unit) {
        glBindSampler(unit, 0);
    }
}

StateGuard::~StateGuard() {
    restore_bindings();
    restore_switches();
}

void StateGuard::save_switches() {
    for (std::size_t i = 0; i < kCapTable.size(); ++i) {
        caps_[i] = glIsEnabled(kCapTable[i].name) == GL_TRUE;
    }
    for (GLuint i = 0; i < kDrawBuffers; ++i) {
        blends_[i] = glIsEnabledi(GL_BLEND, i) == GL_TRUE;
        glGetBooleani_v(GL_COLOR_WRITEMASK, i, colour_masks_[i].data());
    }
    for (std::size_t i = 0; i < kBlendTable.size(); ++i) {
        glGetIntegeri_v(kBlendTable[i], 0, &blend_[i]);
    }
    for (std::size_t i = 0; i < kPixelStoreTable.size(); ++i) {
        glGetIntegerv(kPixelStoreTable[i], &pixel_stores_[i]);
    }
    glGetIntegerv(GL_POLYGON_MODE, polygon_mode_.data());
    glGetFloati_v(GL_VIEWPORT, 0, viewport_.data());
    glGetDoublei_v(GL_DEPTH_RANGE, 0, depth_range_.data());
    scissor_ = glIsEnabledi(GL_SCISSOR_TEST, 0) == GL_TRUE;
    GLboolean mask = GL_TRUE;
    glGetBooleanv(GL_DEPTH_WRITEMASK, &mask);
    depth_mask_ = mask == GL_TRUE;
    glGetIntegerv(GL_CULL_FACE_MODE, &cull_face_);
    glGetIntegerv(GL_FRONT_FACE, &front_face_);
    glGetIntegerv(GL_DEPTH_FUNC, &depth_func_);
    glGetIntegerv(GL_CLIP_ORIGIN, &clip_origin_);
    glGetIntegerv(GL_CLIP_DEPTH_MODE, &clip_depth_);
    glGetIntegerv(GL_PROVOKING_VERTEX, &provoking_);
    glGetIntegerv(GL_PATCH_VERTICES, &patch_vertices_);
}

void StateGuard::save_bindings() {
    glGetIntegerv(GL_CURRENT_PROGRAM, &program_);
    glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &vertex_array_);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_framebuffer_);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_framebuffer_);
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active_unit_);
    for (std::size_t i = 0; i < kBufferTable.size(); ++i) {
        glGetIntegerv(kBufferTable[i].binding, &buffers_[i]);
    }
    for (GLuint i = 0; i < kUniformBuffers; ++i) {
        glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, i, &uniform_[i].buffer);
        glGetInteger64i_v(GL_UNIFORM_BUFFER_START, i, &uniform_[i].first);
        glGetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, i, &uniform_[i].size);
    }
    for (GLuint i = 0; i < kStorageBuffers; ++i) {
        glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, i, &storage_[i].buffer);
        glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, i, &storage_[i].first);
        glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, i, &storage_[i].size);
    }
    for (GLuint unit = 0; unit < kUnits; ++unit) {
        for (std::size_t i = 0; i < kTextureTable.size(); ++i) {
            glGetIntegeri_v(kTextureTable[i].binding, unit, &textures_[unit][i]);
        }
        glGetIntegeri_v(GL_SAMPLER_BINDING, unit, &samplers_[unit]);
    }
    for (std::size_t i = 0; i < kImageTable.size(); ++i) {
        glGetIntegeri_v(kImageTable[i], 0, &image_[i]);
    }
}

void StateGuard::restore_switches() const {
    for (std::size_t i = 0; i < kCapTable.size(); ++i) {
        set_switch(kCapTable[i].name, caps_[i]);
    }
    for (GLuint i = 0; i < kDrawBuffers; ++i) {
        set_switch_at(GL_BLEND, i, blends_[i]);
        glColorMaski(i, colour_masks_[i][0], colour_masks_[i][1], colour_masks_[i][2],
                     colour_masks_[i][3]);
    }
    glBlendFuncSeparatei(0, static_cast<GLenum>(blend_[0]), static_cast<GLenum>(blend_[1]),
                         static_cast<GLenum>(blend_[2]), static_cast<GLenum>(blend_[3]));
    glBlendEquationSeparatei(0, static_cast<GLenum>(blend_[4]), static_cast<GLenum>(blend_[5]));
    for (std::size_t i = 0; i < kPixelStoreTable.size(); ++i) {
        glPixelStorei(kPixelStoreTable[i], pixel_stores_[i]);
    }
    glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygon_mode_[0]));
    glViewportIndexedfv(0, viewport_.data());
    glDepthRangeIndexed(0, depth_range_[0], depth_range_[1]);
    set_switch_at(GL_SCISSOR_TEST, 0, scissor_);
    glDepthMask(depth_mask_ ? GL_TRUE : GL_FALSE);
    glCullFace(static_cast<GLenum>(cull_face_));
    glFrontFace(static_cast<GLenum>(front_face_));
    glDepthFunc(static_cast<GLenum>(depth_func_));
    glClipControl(static_cast<GLenum>(clip_origin_), static_cast<GLenum>(clip_depth_));
    glProvokingVertex(static_cast<GLenum>(provoking_));
    glPatchParameteri(GL_PATCH_VERTICES, patch_vertices_);
}

void StateGuard::restore_bindings() const {
    glUseProgram(static_cast<GLuint>(program_));
    glBindVertexArray(static_cast<GLuint>(vertex_array_));
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_framebuffer_));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_framebuffer_));
    const auto bind_ranges = [](GLenum target, const auto& ranges) {
        for (GLuint i = 0; i < ranges.size(); ++i) {
            const Range& range = ranges[i];
            if (range.size > 0) {
                glBindBufferRange(target, i, static_cast<GLuint>(range.buffer),
                                  static_cast<GLintptr>(range.first),
                                  static_cast<GLsizeiptr>(range.size));
            } else {
                glBindBufferBase(target, i, static_cast<GLuint>(range.buffer));
            }
        }
    };
    bind_ranges(GL_UNIFORM_BUFFER, uniform_);
    bind_ranges(GL_SHADER_STORAGE_BUFFER, storage_);
    for (std::size_t i = 0; i < kBufferTable.size();
         ++i) { // after the ranges, which bind their targets too
        glBindBuffer(kBufferTable[i].target, static_cast<GLuint>(buffers_[i]));
    }
    for (GLuint unit = 0; unit < kUnits; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        for (std::size_t i = 0; i < kTextureTable.size(); ++i) {
            glBindTexture(kTextureTable[i].target, static_cast<GLuint>(textures_[unit][i]));
        }
        glBindSampler(unit, static_cast<GLuint>(samplers_[unit]));
    }
    glActiveTexture(static_cast<GLenum>(active_unit_));
    glBindImageTexture(0, static_cast<GLuint>(image_[0]), image_[1],
                       static_cast<GLboolean>(image_[2] != 0), image_[3],
                       static_cast<GLenum>(image_[4]), static_cast<GLenum>(image_[5]));
}

} // namespace sward::gl
