// SPDX-License-Identifier: Apache-2.0
#include "gl/pass.h"

#include <algorithm>
#include <utility>

#include <epoxy/gl.h>

#include "gl/breath.h"

namespace sward::gl {

namespace {
std::function<void()> g_breath;
} // namespace

void set_breath(std::function<void()> breath) {
    g_breath = std::move(breath);
}

void breathe() {
    if (g_breath) {
        g_breath();
    }
}

PassTimers::~PassTimers() {
    glDeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

std::uint32_t PassTimers::next_query() {
    if (used_ == queries_.size()) {
        std::uint32_t query = 0;
        glCreateQueries(GL_TIMESTAMP, 1, &query);
        queries_.push_back(query);
    }
    return queries_[used_++];
}

void PassTimers::begin_frame(bool wait) {
    wait_ = wait;
    entries_.clear();
    used_ = 0;
}

std::vector<PassTimers::Row> PassTimers::rows() {
    std::vector<Row> rows;
    for (const Entry& entry : entries_) {
        GLuint64 begin = 0, end = 0;
        glGetQueryObjectui64v(entry.begin_query, GL_QUERY_RESULT, &begin);
        glGetQueryObjectui64v(entry.end_query, GL_QUERY_RESULT, &end);
        auto row = std::find_if(rows.begin(), rows.end(),
                                [&](const Row& r) { return r.name == entry.name; });
        if (row == rows.end()) {
            row = rows.insert(rows.end(), Row{entry.name, 0, 0});
        }
        row->gpu_ms += static_cast<double>(end - begin) * 1e-6;
        row->cpu_ms += entry.cpu_ms;
    }
    return rows;
}

PassScope::PassScope(PassTimers& timers, const char* name)
    : timers_(timers), entry_(timers.entries_.size()) {
    breathe();
    if (timers_.wait_) {
        glFinish();
    }
    start_ = std::chrono::steady_clock::now();
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
    timers_.entries_.push_back({name, timers_.next_query(), timers_.next_query(), 0});
    glQueryCounter(timers_.entries_[entry_].begin_query, GL_TIMESTAMP);
}

PassScope::~PassScope() {
    glQueryCounter(timers_.entries_[entry_].end_query, GL_TIMESTAMP);
    if (timers_.wait_) {
        glFinish();
    }
    const std::chrono::duration<double, std::milli> passed =
        std::chrono::steady_clock::now() - start_;
    timers_.entries_[entry_].cpu_ms = passed.count();
    glPopDebugGroup();
}

} // namespace sward::gl
