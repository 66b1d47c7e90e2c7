// SPDX-License-Identifier: Apache-2.0
#include "app/panel.h"

#include <algorithm>
#include <cmath>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include "app/keys.h"

namespace sward::app {
namespace {

// Order of the enums in render/settings.h.
constexpr const char* kTierNames = "all\0blades\0shells\0reference\0";
constexpr const char* kHandoverNames = "rank (ships)\0off: both tiers whole\0hard switch\0fade\0";
template<class Enum> void combo(const char* label, Enum& value, const char* names) {
    int index = static_cast<int>(value);
    if (ImGui::Combo(label, &index, names))
        value = static_cast<Enum>(index);
}

void slider(const char* label, double& value, double least, double most) {
    ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &least, &most, "%.0f m",
                        ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
}

void draw_time(SimClock& clock, Weather& weather) {
    if (!ImGui::CollapsingHeader("Time and weather", ImGuiTreeNodeFlags_DefaultOpen))
        return;
    const auto drag = [](const char* label, double& value, double most, const char* format) {
        constexpr double kLeast = 0;
        ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &kLeast, &most, format,
                            ImGuiSliderFlags_AlwaysClamp);
    };
    bool running = !clock.paused();
    if (ImGui::Checkbox("time goes on", &running))
        clock.toggle_pause();
    ImGui::SameLine();
    if (ImGui::SmallButton("step"))
        clock.single_step();
    ImGui::SameLine();
    if (ImGui::SmallButton("-"))
        clock.slower();
    ImGui::SameLine();
    if (ImGui::SmallButton("+"))
        clock.faster();
    ImGui::SameLine();
    ImGui::Text("x%g", clock.rate());
    drag("time of day", weather.hour, 24, hour_text(weather.hour).c_str());
    drag("wind", weather.wind.speed_mps, Weather::kMostWind_mps, "%.1f m/s");
    drag("wind from", weather.wind.direction_deg, 360, "%.0f deg");
    drag("gusts", weather.wind.gust, 1, "%.2f");
}

void draw_cameras(const std::vector<std::string>& cameras, std::optional<int>& chosen) {
    if (cameras.empty() || !ImGui::CollapsingHeader("Cameras"))
        return;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const std::string label =
            i < 9 ? std::to_string(i + 1) + "  " + cameras[i] : "    " + cameras[i];
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Selectable(label.c_str()))
            chosen = static_cast<int>(i);
        ImGui::PopID();
    }
}

void draw_settings(render::FrameSettings& s) {
    if (!ImGui::CollapsingHeader("Tiers"))
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
}

void draw_passes(const render::FrameStats& stats) {
    if (!ImGui::CollapsingHeader("Passes") ||
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
    ImGui::Text("%.1f ms a frame", facts.frame_ms);
    if (!facts.note.empty())
        ImGui::TextUnformatted(facts.note.c_str());
    ImGui::Text("x %.1f  z %.1f  %.2f m above ground", p.x, p.z, p.y - facts.ground_m);
    ImGui::Text("yaw %.1f  pitch %.1f", facts.pose.yaw_deg, facts.pose.pitch_deg);
    ImGui::TextDisabled("%s", facts.gpu.c_str());
    ImGui::TextDisabled("H help");
}

void in_the_middle() {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x * 0.5f, size.y * 0.5f}, ImGuiCond_Always, {0.5f, 0.5f});
}

constexpr ImGuiWindowFlags kBox = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse;
constexpr ImU32 kInk = IM_COL32(240, 244, 236, 255);
constexpr float kLineHeight = 22; // of the line, pixels

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

void Panel::begin() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Panel::end() {
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, 0); // ImGui draws wherever the renderer left off
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Panel::draw(PanelEdits& edits, const PanelFacts& facts) {
    if (!shown)
        return;
    ImGui::SetNextWindowPos({10, kLineHeight + 10}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({310, 0}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Sward")) {
        ImGui::PushItemWidth(150);
        draw_time(edits.clock, edits.weather);
        draw_cameras(facts.cameras, edits.camera);
        draw_settings(edits.settings);
        draw_passes(facts.stats);
        draw_facts(facts);
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

void Panel::draw_line(const std::string& line) {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    // A narrow window has it in two rows, or three.
    const float width = ImGui::GetIO().DisplaySize.x, wrap = std::max(60.0f, width - 20);
    const float height = ImGui::CalcTextSize(line.c_str(), nullptr, false, wrap).y;
    list.AddRectFilled({0, 0}, {width, height + kLineHeight - ImGui::GetTextLineHeight()},
                       IM_COL32(0, 0, 0, 150));
    list.AddText(nullptr, 0, {10, 4}, kInk, line.c_str(), nullptr, wrap);
}

void Panel::draw_help() {
    if (!help)
        return;
    in_the_middle();
    if (ImGui::Begin("Help", &help, kBox)) {
        for (const std::string_view line : motion_lines())
            ImGui::TextUnformatted(line.data(), line.data() + line.size());
        ImGui::Separator();
        for (const KeyBinding& binding : key_bindings())
            ImGui::Text("%-10.*s %.*s", static_cast<int>(binding.name.size()), binding.name.data(),
                        static_cast<int>(binding.help.size()), binding.help.data());
    }
    ImGui::End();
}

std::optional<std::filesystem::path>
Panel::draw_recent(const std::vector<std::filesystem::path>& scenes) {
    if (!recent)
        return {};
    std::optional<std::filesystem::path> chosen;
    in_the_middle();
    if (ImGui::Begin("Recent scenes", &recent, kBox)) {
        for (const std::filesystem::path& scene : scenes)
            if (ImGui::Selectable(scene.c_str()))
                chosen = scene;
        if (scenes.empty())
            ImGui::TextDisabled("none yet");
        ImGui::TextDisabled("or drop a scene or an elevation file onto the window");
    }
    ImGui::End();
    recent = recent && !chosen;
    return chosen;
}

void Panel::draw_messages(const std::vector<std::string>& messages) {
    if (messages.empty())
        return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({10, size.y - 10}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowSizeConstraints({200, 0}, {size.x - 20, size.y * 0.5f});
    if (ImGui::Begin("Shaders that did not build", nullptr, kBox))
        for (const std::string& message : messages)
            ImGui::TextUnformatted(message.c_str());
    ImGui::End();
}

void Panel::draw_word(const std::string& word) {
    if (word.empty())
        return;
    const ImVec2 size = ImGui::GetIO().DisplaySize,
                 text = ImGui::CalcTextSize(word.c_str(), nullptr, false, size.x - 40);
    const ImVec2 at{(size.x - text.x) * 0.5f, size.y - text.y - 16};
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRectFilled({at.x - 8, at.y - 4}, {at.x + text.x + 8, at.y + text.y + 4},
                       IM_COL32(0, 0, 0, 150), 4);
    list.AddText(nullptr, 0, at, kInk, word.c_str(), nullptr, size.x - 40);
}

void Panel::draw_load(const std::string& scene, const std::string& what, double share,
                      double elapsed_s) {
    in_the_middle();
    constexpr ImGuiWindowFlags kPlain = kBox | ImGuiWindowFlags_NoTitleBar |
                                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
    if (ImGui::Begin("Loading", nullptr, kPlain)) {
        ImGui::TextUnformatted(scene.c_str());
        ImGui::TextUnformatted(what.c_str());
        const float width = std::max(120.0f, std::min(400.0f, ImGui::GetIO().DisplaySize.x - 60));
        if (share >= 0)
            ImGui::ProgressBar(static_cast<float>(share), {width, 0});
        else // how far it is nobody knows; that it goes on, one sees
            ImGui::ProgressBar(static_cast<float>(elapsed_s - std::floor(elapsed_s)), {width, 6},
                               "");
        ImGui::TextDisabled("%.0f s    Esc ends", elapsed_s);
    }
    ImGui::End();
}

} // namespace sward::app
