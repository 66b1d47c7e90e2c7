// SPDX-License-Identifier: Apache-2.0
// The arrow editor's model, and scene files that it saves into.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "scene/arrow_edit.h"
#include "scene/arrow_text.h"
#include "scene/scene.h"

namespace sward::scene {
namespace {

namespace fs = std::filesystem;

WindArrow arrow(const std::string& id, const std::string& parent, glm::dvec2 root, glm::dvec2 tip) {
    WindArrow a;
    a.id = id, a.parent = parent, a.root = root, a.tip = tip, a.strength_mps = 5, a.radius_m = 2;
    return a;
}

/// trunk from (0, 0) to (10, 0), two that continue it, one that continues "left".
std::vector<WindArrow> tree() {
    return {arrow("trunk", "", {0, 0}, {10, 0}), arrow("left", "trunk", {10, 0}, {15, -5}),
            arrow("right", "trunk", {10, 0}, {15, 5}), arrow("leaf", "left", {15, -5}, {20, -5})};
}

TEST(ArrowEdit, AddsAndBranches) {
    ArrowEdit edit({});
    const auto root = edit.add({1, 2}, {4, 6.00049});
    ASSERT_TRUE(root);
    EXPECT_EQ(edit.arrows()[*root].tip, glm::dvec2(4, 6)) << "whole millimetres";
    const auto branch = edit.branch(*root, {9, 9});
    ASSERT_TRUE(branch);
    const WindArrow& b = edit.arrows()[*branch];
    EXPECT_EQ(b.parent, edit.arrows()[*root].id);
    EXPECT_EQ(b.root, glm::dvec2(4, 6));
    EXPECT_EQ(b.strength_mps, edit.arrows()[*root].strength_mps);
    EXPECT_NE(b.id, b.parent);
    EXPECT_FALSE(edit.add({1, 1}, {1.01, 1})) << "too short";
    EXPECT_FALSE(edit.branch(*root, {4, 6}));
    EXPECT_FALSE(edit.add({1, 1}, {NAN, 1}));
    EXPECT_EQ(edit.arrows().size(), 2u);
}

TEST(ArrowEdit, AMovedTipTakesItsChildrenAlong) {
    ArrowEdit edit(tree());
    EXPECT_TRUE(edit.move({0, ArrowEnd::kTip}, {12, 1}));
    EXPECT_EQ(edit.arrows()[1].root, glm::dvec2(12, 1));
    EXPECT_EQ(edit.arrows()[2].root, glm::dvec2(12, 1));
    EXPECT_EQ(edit.arrows()[3].root, glm::dvec2(15, -5)) << "not a grandchild";
    EXPECT_TRUE(edit.move({1, ArrowEnd::kRoot}, {11, 0}))
        << "a root that sits on a tip is that tip";
    EXPECT_EQ(edit.arrows()[0].tip, glm::dvec2(11, 0));
    EXPECT_EQ(edit.arrows()[2].root, glm::dvec2(11, 0));
    EXPECT_FALSE(edit.move({0, ArrowEnd::kTip}, {15, 5}))
        << "the child to the right would have no length";
    EXPECT_EQ(edit.arrows()[0].tip, glm::dvec2(11, 0));
    EXPECT_TRUE(edit.move({0, ArrowEnd::kRoot}, {-3, 0}));
    EXPECT_FALSE(edit.move({0, ArrowEnd::kRoot}, {INFINITY, 0}));
}

TEST(ArrowEdit, APointTakenOutJoinsWhatItJoined) {
    ArrowEdit edit(tree());
    edit.erase(1); // left
    ASSERT_EQ(edit.arrows().size(), 3u);
    const WindArrow& leaf = edit.arrows()[2];
    EXPECT_EQ(leaf.id, "leaf");
    EXPECT_EQ(leaf.parent, "trunk");
    EXPECT_EQ(leaf.root, glm::dvec2(10, 0));
    edit.erase(0);
    EXPECT_EQ(edit.arrows()[0].parent, "") << "a child of a root becomes a root";
    ArrowEdit whole(tree());
    whole.erase_branch(1);
    ASSERT_EQ(whole.arrows().size(), 2u);
    EXPECT_EQ(whole.arrows()[1].id, "right");
    ArrowEdit back({arrow("a", "", {0, 0}, {5, 0}), arrow("b", "a", {5, 0}, {0, 0}),
                    arrow("c", "b", {0, 0}, {3, 3})});
    back.erase(0);
    EXPECT_TRUE(back.arrows().empty())
        << "b runs back to a's root: it would have no length, and c hangs on it";
}

TEST(ArrowEdit, NumbersStayInTheirRanges) {
    ArrowEdit edit(tree());
    edit.set_strength(0, 1e9);
    edit.set_radius(0, -4);
    EXPECT_EQ(edit.arrows()[0].strength_mps, 300);
    EXPECT_EQ(edit.arrows()[0].radius_m, 0.01);
    edit.set_strength(0, NAN);
    EXPECT_EQ(edit.arrows()[0].strength_mps, 300);
}

TEST(ArrowEdit, FindsTheNearestPoint) {
    const ArrowEdit edit(tree());
    EXPECT_EQ(edit.nearest({10.2, 0.1}, 1), (ArrowHandle{0, ArrowEnd::kTip}))
        << "before the roots on it";
    EXPECT_EQ(edit.nearest({0.2, 0.1}, 1), (ArrowHandle{0, ArrowEnd::kRoot}));
    EXPECT_EQ(edit.nearest({20, -4.5}, 1), (ArrowHandle{3, ArrowEnd::kTip}));
    EXPECT_FALSE(edit.nearest({5, 0}, 1));
}

TEST(ArrowEdit, UndoesAndRedoes) {
    ArrowEdit edit(tree());
    EXPECT_FALSE(edit.undo());
    edit.erase(1);
    const auto erased = edit.arrows();
    edit.begin();
    for (int i = 1; i <= 20; ++i)
        EXPECT_TRUE(edit.move({0, ArrowEnd::kTip}, {10 + i, 3}));
    edit.end();
    const auto dragged = edit.arrows();
    EXPECT_TRUE(edit.undo());
    EXPECT_EQ(edit.arrows(), erased) << "a drag is one change";
    EXPECT_TRUE(edit.undo());
    EXPECT_EQ(edit.arrows(), tree());
    EXPECT_FALSE(edit.unsaved());
    EXPECT_TRUE(edit.redo());
    EXPECT_TRUE(edit.redo());
    EXPECT_EQ(edit.arrows(), dragged);
    EXPECT_FALSE(edit.redo());
    EXPECT_TRUE(edit.undo());
    edit.set_strength(0, 7);
    EXPECT_FALSE(edit.can_redo()) << "a new change ends what was undone";
    EXPECT_TRUE(edit.unsaved());
    edit.set_saved();
    EXPECT_FALSE(edit.unsaved());
    edit.set_strength(0, 7);
    EXPECT_TRUE(edit.undo()) << "no change, no step";
    EXPECT_EQ(edit.arrows(), erased);
    for (int i = 0; i < 1000; ++i)
        edit.set_strength(0, i % 300);
    int steps = 0;
    while (edit.undo())
        ++steps;
    EXPECT_EQ(steps, static_cast<int>(ArrowEdit::kMostUndo));
}

const std::string kText = R"(# A scene, by hand: übermäßig kommentiert.
[terrain]
elevation = "height.tif"   # the hill

[wind]
speed_mps = 3 # [[wind.arrow]] in a comment

# The trunk.
[[wind.arrow]]
id = "trunk"               # ä: a name
root = [0, 0]
tip = [10.0, 0]            # to the wood
strength_mps = 5.0
radius_m = 2

[[wind.arrow]]
id = "left"
parent = "trunk"
root = [10, 0]
tip = [
    15,
    -5, # north
]
strength_mps = 5
radius_m = 2
start_s = 1.5
# The barn.
[[wind.obstacle]]
circle = [12, -3, 2.5]

[[wind.arrow]]
id = "right"
parent = "trunk"
root = [10, 0]
tip = [15, 5]
strength_mps = 5
[camera.road]
position = [0, 1.7, 0]     # last line, no newline)";

std::vector<WindArrow> arrows_of(const std::string& text) {
    return parse_scene(text, "s.toml").wind.arrows;
}
std::string saved(const std::string& text, const std::vector<WindArrow>& arrows) {
    return with_arrows(text, arrows, "s.toml");
}
std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(ArrowText, NothingChangedIsTheSameBytes) {
    EXPECT_EQ(saved(kText, arrows_of(kText)), kText);
}

TEST(ArrowText, OlderSpellingsOfSpeedsAreRead) {
    const auto scene = parse_scene(replaced(replaced(kText, "speed_mps = 3", "speed_ms = 7"),
                                            "strength_mps = 5.0", "strength_ms = 2"),
                                   "s.toml");
    EXPECT_EQ(scene.wind.speed_mps, 7);
    EXPECT_EQ(scene.wind.arrows.at(0).strength_mps, 2);
    EXPECT_THROW(static_cast<void>(arrows_of(replaced(kText, "speed_mps = 3", "speed_ms = -7"))),
                 sward::base::Error);
    EXPECT_THROW(static_cast<void>(
                     arrows_of(replaced(kText, "speed_mps = 3", "speed_ms = 7\nspeed_mps = 3"))),
                 sward::base::Error)
        << "one of the two";
}

TEST(ArrowText, AnOlderFileKeepsItsSpelling) {
    const std::string old = replaced(kText, "strength_mps = 5.0\n", "strength_ms = 5.0\n");
    auto arrows = arrows_of(old);
    arrows[0].strength_mps = 6;
    EXPECT_EQ(saved(old, arrows), replaced(old, "strength_ms = 5.0", "strength_ms = 6"));
}

TEST(ArrowText, ChangesOnlyTheValuesThatChanged) {
    auto arrows = arrows_of(kText);
    arrows[0].tip = {11, 0.5};
    arrows[1].root = {11, 0.5};
    arrows[1].tip = {15, -6};
    arrows[2].radius_m = 3;
    std::string expected =
        replaced(kText, "[10.0, 0]            # to", "[11, 0.5]            # to");
    expected = replaced(expected, "root = [10, 0]", "root = [11, 0.5]");
    expected = replaced(expected, "[\n    15,\n    -5, # north\n]", "[15, -6]");
    expected = replaced(expected, "tip = [15, 5]\nstrength_mps = 5\n",
                        "tip = [15, 5]\nstrength_mps = 5\nradius_m = 3\n");
    EXPECT_EQ(saved(kText, arrows), expected);
    EXPECT_EQ(arrows_of(expected), arrows);
}

TEST(ArrowText, CutsAndAppendsBlocks) {
    auto arrows = arrows_of(kText);
    arrows.erase(arrows.begin() + 1);
    arrows.push_back(arrow("new", "trunk", {10, 0}, {12.25, 7}));
    const std::string text = saved(kText, arrows);
    EXPECT_EQ(arrows_of(text), arrows);
    EXPECT_NE(text.find("# The barn.\n[[wind.obstacle]]"), std::string::npos)
        << "the next block's comment stays";
    EXPECT_EQ(text.find("north"), std::string::npos);
    EXPECT_NE(text.find("strength_mps = 5\n\n[[wind.arrow]]\nid = \"new\"\nparent = "
                        "\"trunk\"\nroot = [10, 0]\ntip = [12.25, 7]\n"
                        "strength_mps = 5\nradius_m = 2\n[camera.road]"),
              std::string::npos)
        << text;
    const std::string bare = saved(kText, {});
    EXPECT_TRUE(arrows_of(bare).empty());
    EXPECT_NE(bare.find("# The trunk."), std::string::npos)
        << "comments between blocks are nobody's to cut";
    // Without any: at the end, and the file gets the newline that it lacks.
    const std::string end = saved("[terrain]\nelevation = \"a\"", {arrow("a", "", {0, 0}, {1, 0})});
    EXPECT_TRUE(end.starts_with("[terrain]\nelevation = \"a\"\n\n[[wind.arrow]]\n")) << end;
    EXPECT_EQ(arrows_of(end).size(), 1u);
}

TEST(ArrowText, ARootMadeOfABranchLosesItsParent) {
    auto arrows = arrows_of(kText);
    arrows.erase(arrows.begin());
    arrows[0].parent = arrows[1].parent = "";
    EXPECT_EQ(arrows_of(saved(kText, arrows)), arrows);
}

TEST(ArrowText, KeepsLineEndings) {
    std::string text;
    for (const char c : kText)
        text += c == '\n' ? "\r\n" : std::string(1, c);
    auto arrows = arrows_of(text);
    arrows[1].tip = {0.5, 0.5};
    arrows.push_back(arrow("new", "", {0, 0}, {1, 1}));
    const std::string out = saved(text, arrows);
    EXPECT_EQ(arrows_of(out).size(), 4u);
    for (std::size_t i = 0; i < out.size(); ++i)
        ASSERT_TRUE(out[i] != '\n' || out[i - 1] == '\r') << i;
}

TEST(ArrowText, AnythingThatTheEditorDoesReadsBackEqual) {
    std::mt19937 random(3);
    const auto number = [&](double most) {
        return std::uniform_real_distribution<double>(0, most)(random);
    };
    std::string text = kText;
    for (int round = 0; round < 60; ++round) {
        ArrowEdit edit(arrows_of(text));
        for (int i = 0; i < 6; ++i) {
            const std::size_t count = edit.arrows().size();
            const std::size_t any =
                count > 0 ? static_cast<std::size_t>(number(static_cast<double>(count) - 1e-9)) : 0;
            const glm::dvec2 place(number(60) - 30, number(60) - 30);
            switch (count == 0 ? 0 : static_cast<int>(number(6.999))) {
            case 0:
                (void)edit.add(place, place + glm::dvec2(3, 1));
                break;
            case 1:
                (void)edit.branch(any, place);
                break;
            case 2:
                (void)edit.move({any, ArrowEnd::kTip}, place);
                break;
            case 3:
                (void)edit.move({any, ArrowEnd::kRoot}, place);
                break;
            case 4:
                edit.erase(any);
                break;
            case 5:
                edit.set_strength(any, number(20));
                break;
            default:
                (void)edit.undo();
                break;
            }
        }
        text = saved(text, edit.arrows());
        const auto back = arrows_of(text);
        ASSERT_EQ(back.size(), edit.arrows().size());
        for (const WindArrow& a : edit.arrows())
            ASSERT_NE(std::find(back.begin(), back.end(), a), back.end()) << a.id << "\n" << text;
    }
    EXPECT_NE(text.find("übermäßig"), std::string::npos);
    EXPECT_NE(text.find("# The barn."), std::string::npos);
    EXPECT_NE(text.find("position = [0, 1.7, 0]     # last line, no newline"), std::string::npos);
}

TEST(ArrowText, SavingIsWholeOrNot) {
    std::string name = (fs::temp_directory_path() / "sward_arrows_XXXXXX").string();
    const fs::path dir = ::mkdtemp(name.data());
    const fs::path file = dir / "scene.toml";
    const auto put = [&](const std::string& text) {
        std::ofstream(file, std::ios::binary) << text;
    };
    const auto message = [&](const std::vector<WindArrow>& arrows) {
        try {
            save_arrows(file, arrows);
        } catch (const base::Error& error) {
            return std::string(error.what()).substr(dir.string().size() + 1);
        }
        return std::string("saved");
    };
    put(kText);
    EXPECT_EQ(message({arrow("a", "", {0, 0}, {1, 0})}), "saved");
    EXPECT_EQ(load_scene(file).wind.arrows.size(), 1u);
    // A form that cannot be replaced, an arrow that no file may hold, a file that is broken: told,
    // and left alone.
    const std::string line = "[terrain]\nelevation = \"a\"\n[wind]\narrow = [{ id = \"a\", root = "
                             "[0, 0], tip = [1, 0], strength_mps = 1 }]\n";
    for (const auto& [text, piece] :
         {std::pair<std::string, std::string>{line, "wind.arrow: found an array in one line"},
          {"wind = { speed_mps = 4 }\n[terrain]\nelevation = \"a\"\n", "not valid TOML"},
          {"[terrain", "not valid TOML"}}) {
        put(text);
        EXPECT_NE(message({arrow("b", "", {0, 0}, {1, 0})}).find(piece), std::string::npos)
            << message({});
        EXPECT_EQ(base::read_text(file, 1 << 20), text);
    }
    put(kText);
    EXPECT_NE(message({arrow("a", "nobody", {0, 0}, {1, 0})}).find("wind.arrow[0].parent"),
              std::string::npos);
    EXPECT_EQ(base::read_text(file, 1 << 20), kText);
    EXPECT_EQ(std::distance(fs::directory_iterator(dir), fs::directory_iterator()), 1)
        << "no temporary stays";
    fs::remove_all(dir);
}

} // namespace
} // namespace sward::scene
