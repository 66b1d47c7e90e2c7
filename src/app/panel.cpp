// SPDX-License-Identifier: Apache-2.0
#include "app/panel.h"

#include <array>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include "app/window.h"

namespace sward::app {
namespace {

// Order of the enums in render/settings.h.
constexpr const char* kTierNames = "all\0blades\0shells\0reference\0";
constexpr const char* kHandoverNames = "rank (ships)\0off: both tiers whole\0hard switch\0fade\0";
constexpr std::array<const char*, 5> kMotion = {
    "W A S D    fly, sideways       Q E    down, up", "right mouse button    look",
    "wheel    speed       shift    eight times as fast",
    "gamepad    left stick fly, right stick look, triggers down and up,", "    right bumper fast"};

template<class Enum> void combo(const char* label, Enum& value, const char* names) {
    int index = static_cast<int>(value);
    if (ImGui::Combo(label, &index, names))
        value = static_cast<Enum>(index);
}

void slider(const char* label, double& value, double least, double most) {
    ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &least, &most, "%.0f m",
                        ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
}

void draw_settings(render::FrameSettings& s, bool& running) {
    if (!ImGui::CollapsingHeader("Tiers", ImGuiTreeNodeFlags_DefaultOpen))
        return;
    ImGui::Checkbox("terrain", &s.terrain);
    ImGui::SameLine();
    ImGui::Checkbox("sky", &s.sky);
    ImGui::Checkbox("blades", &s.blades);
    ImGui::SameLine();
    ImGui::Checkbox("shells", &s.shells);
    ImGui::SameLine();
    ImGui::Checkbox("slices", &s.slices);
    combo("draw", s.tiers, kTierNames);
    combo("hand-over", s.handover, kHandoverNames);
    ImGui::SliderInt("far level", &s.force_far_level, -1, 7,
                     s.force_far_level < 0 ? "by distance" : "%d", ImGuiSliderFlags_AlwaysClamp);
    if (s.tiers == render::Tiers::kBlades)
        slider("blades to", s.blades_distance_m, 1, 1000);
    if (s.tiers == render::Tiers::kReference) {
        slider("reference to", s.reference_distance_m, 1, 200);
        ImGui::SliderInt("grid", &s.reference_grid, 1, 8, "%d", ImGuiSliderFlags_AlwaysClamp);
    }
    ImGui::SliderFloat("exposure", &s.exposure, 0.05f, 20, "%.2f",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    int power = s.samples >= 4 ? 2 : s.samples - 1;
    if (ImGui::Combo("MSAA", &power,
                     "1\0"
                     "2\0"
                     "4\0"))
        s.samples = 1 << power;
    ImGui::Checkbox("time goes on", &running);
}

void draw_passes(const render::FrameStats& stats) {
    if (!ImGui::CollapsingHeader("Passes", ImGuiTreeNodeFlags_DefaultOpen) ||
        !ImGui::BeginTable("passes", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp))
        return;
    ImGui::TableSetupColumn("pass");
    ImGui::TableSetupColumn("GPU ms");
    ImGui::TableSetupColumn("CPU ms");
    ImGui::TableHeadersRow();
    for (const render::PassTime& pass : stats.passes) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(pass.name.c_str());
        ImGui::TableNextColumn();
        ImGui::Text("%.2f", pass.gpu_ms);
        ImGui::TableNextColumn();
        ImGui::Text("%.2f", pass.cpu_ms);
    }
    ImGui::EndTable();
}

void draw_facts(const PanelFacts& facts) {
    const auto count = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    if (ImGui::CollapsingHeader("Statistics", ImGuiTreeNodeFlags_DefaultOpen)) {
        ImGui::Text("blades considered  %llu", count(facts.stats.blades_considered));
        ImGui::Text("blades drawn       %llu", count(facts.stats.blades_drawn));
        ImGui::Text("shell fragments    %llu", count(facts.stats.shell_fragments));
        ImGui::Text("slice fragments    %llu", count(facts.stats.slice_fragments));
        ImGui::Text("GPU memory         %.1f MiB",
                    static_cast<double>(facts.stats.gpu_bytes) / 1048576.0);
    }
    const glm::dvec3& p = facts.pose.position;
    ImGui::Separator();
    ImGui::Text("%.1f ms a frame, %s, t %.1f s", facts.frame_ms, facts.note.c_str(),
                facts.time_s);
    ImGui::Text("x %.1f  z %.1f  %.2f m above ground", p.x, p.z, p.y - facts.ground_m);
    ImGui::Text("yaw %.1f  pitch %.1f", facts.pose.yaw_deg, facts.pose.pitch_deg);
    ImGui::TextDisabled("%s", facts.gpu.c_str());
    ImGui::TextDisabled("H help");
}

void draw_help(bool* open) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x * 0.5f, size.y * 0.5f}, ImGuiCond_Always, {0.5f, 0.5f});
    if (ImGui::Begin("Help", open,
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
        for (const char* line : kMotion)
            ImGui::TextUnformatted(line);
        ImGui::Separator();
        for (const KeyBinding& key : kKeys)
            ImGui::Text("%-7s %s", key.name, key.help);
    }
    ImGui::End();
}

void draw_messages(const std::vector<std::string>& messages) {
    if (messages.empty())
        return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({10, size.y - 10}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowSizeConstraints({200, 0}, {size.x - 20, size.y * 0.5f});
    if (ImGui::Begin("Shaders that did not build", nullptr,
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse))
        for (const std::string& message : messages)
            ImGui::TextUnformatted(message.c_str());
    ImGui::End();
}

} // namespace

Panel::Panel(GLFWwindow* window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // a viewer leaves no files about
    ImGui::StyleColorsDark();
    ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.85f;
    ImGui_ImplGlfw_InitForOpenGL(window, true); // calls the window's own callbacks too
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

Panel::~Panel() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

bool Panel::has_mouse() const {
    return ImGui::GetIO().WantCaptureMouse;
}
bool Panel::has_keyboard() const {
    return ImGui::GetIO().WantTextInput;
}

void Panel::draw(render::FrameSettings& settings, bool& running, const PanelFacts& facts,
                 const std::function<void()>& more) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    more();
    if (shown) {
        ImGui::SetNextWindowPos({10, 10}, ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSize({310, 0}, ImGuiCond_FirstUseEver);
        if (ImGui::Begin("Sward")) {
            ImGui::PushItemWidth(150);
            draw_settings(settings, running);
            draw_passes(facts.stats);
            draw_facts(facts);
            ImGui::PopItemWidth();
        }
        ImGui::End();
    }
    if (help)
        draw_help(&help);
    draw_messages(facts.messages);
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, 0); // ImGui draws wherever the renderer left off
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

} // namespace sward::app
