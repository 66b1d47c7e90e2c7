// SPDX-License-Identifier: Apache-2.0
#include "app/load_screen.h"

#include <future>
#include <utility>

#include <epoxy/gl.h>

#include "app/world_loader.h"
#include "base/end_at_once.h"
#include "base/error.h"

namespace sward::app {
namespace {

constexpr auto kRedrawEvery = std::chrono::milliseconds(40);

/// What draw() changes of the context and ImGui does not put back.
class StateKeeper {
public:
    StateKeeper() {
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_);
        glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_);
        glGetFloatv(GL_COLOR_CLEAR_VALUE, colour_);
        scissor_ = glIsEnabled(GL_SCISSOR_TEST);
        glDisable(GL_SCISSOR_TEST);
    }
    ~StateKeeper() {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_));
        glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_));
        glClearColor(colour_[0], colour_[1], colour_[2], colour_[3]);
        if (scissor_ == GL_TRUE)
            glEnable(GL_SCISSOR_TEST);
    }
    StateKeeper(const StateKeeper&) = delete;
    StateKeeper& operator=(const StateKeeper&) = delete;

private:
    GLint draw_ = 0, read_ = 0;
    GLfloat colour_[4]{};
    GLboolean scissor_ = GL_FALSE;
};

} // namespace

LoadScreen::LoadScreen(Window& window, Panel& panel, std::string scene)
    : window_(window), panel_(panel), scene_(base::printable(scene, 300)) {}

void LoadScreen::told(std::string_view what, std::optional<double> share) {
    const std::lock_guard lock(mutex_);
    what_ = what;
    share_ = share.value_or(-1);
}

void LoadScreen::draw() {
    const glm::ivec2 size = window_.framebuffer_size();
    if (size.x < 1 || size.y < 1)
        return;
    std::string what;
    double share = 0;
    {
        const std::lock_guard lock(mutex_);
        what = what_;
        share = share_;
    }
    const StateKeeper keeper;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glClearColor(0.06f, 0.07f, 0.08f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    panel_.begin();
    Panel::draw_load(scene_, what, share,
                     std::chrono::duration<double>(Clock::now() - start_).count());
    panel_.end();
    window_.swap();
}

render::World LoadScreen::read(const scene::Scene& scene) {
    auto world = std::async(std::launch::async, [&] {
        return load_world(scene, [this](std::string_view what, std::optional<double> share) {
            told(what, share);
        });
    });
    do {
        window_.listen();
        if (window_.asked_to_end())
            base::end_at_once(0);
        draw();
    } while (world.wait_for(kRedrawEvery) != std::future_status::ready);
    return world.get();
}

void LoadScreen::show(std::string_view what) {
    window_.listen();
    if (window_.asked_to_end())
        throw Stopped{};
    if (Clock::now() - drawn_ < kRedrawEvery)
        return;
    told(what, {});
    draw();
    drawn_ = Clock::now();
}

} // namespace sward::app
