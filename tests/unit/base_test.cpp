// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <set>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"

namespace sward::base {
namespace {

namespace fs = std::filesystem;

class TempDir {
public:
    TempDir() {
        std::string name = (fs::temp_directory_path() / "sward_base_XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~TempDir() { fs::remove_all(path_); }
    fs::path operator/(const fs::path& name) const { return path_ / name; }
    [[nodiscard]] const fs::path& path() const { return path_; }
    /// What lies in the directory, hidden temporaries too.
    [[nodiscard]] std::set<std::string> names() const {
        std::set<std::string> all;
        for (const auto& entry : fs::directory_iterator(path_))
            all.insert(entry.path().filename().string());
        return all;
    }

private:
    fs::path path_;
};

void put(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string get(const fs::path& path) {
    return read_text(path, 1 << 24);
}

/// The error that `act` throws, or one that says that it threw none.
Error error_of(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) {
        return error;
    }
    return {ExitCode::kDone, "no error"};
}

void expect_error(const std::function<void()>& act, ExitCode code, const std::string& part) {
    const Error error = error_of(act);
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
}

/// Runs `act` in a process of its own; its return value is the exit status. 1000 + signal when a
/// signal ended it.
int status_of(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

pid_t start(const std::function<int()>& act) {
    const pid_t child = ::fork();
    if (child == 0)
        ::_exit(act());
    return child;
}

void wait_for(const fs::path& path) {
    for (int i = 0; i < 500 && !fs::exists(path); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_TRUE(fs::exists(path));
}

TEST(Printable, EscapesWhatWouldBreakALine) {
    EXPECT_EQ(printable("meadow.toml"), "meadow.toml");
    EXPECT_EQ(printable("a\nb\tc\r"), "a\\nb\\tc\\r");
    EXPECT_EQ(printable(std::string_view("\0\x1b[31m", 6)), "\\x00\\x1b[31m");
    EXPECT_EQ(printable("Wiese \xc3\xbc"), "Wiese \xc3\xbc");
    EXPECT_EQ(printable("\xff\xc3"), "\\xff\\xc3");
    EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf") << "an overlong form";
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
    EXPECT_EQ(printable("\xe2\x80\xae"), "\\u{202e}") << "right-to-left override";
}

TEST(Printable, ClipsToTheLimitAndIsStableTwice) {
    EXPECT_EQ(printable("abcdefgh", 8), "abcdefgh");
    EXPECT_EQ(printable("abcdefghi", 8), "abcde...");
    EXPECT_EQ(printable(std::string(1000, 'x')).size(), 80u);
    EXPECT_EQ(printable("\xc3\xbc\xc3\xbc\xc3\xbc\xc3\xbc\xc3\xbc", 8), "\xc3\xbc\xc3\xbc...");
    const std::string once = printable("a\n\xff");
    EXPECT_EQ(printable(once), once);
}

TEST(InputError, NamesFileLineFoundAndExpected) {
    const Error error =
        input_error(ExitCode::kBadInput, "scene.toml", 7, "wind.gust", "2", "0 to 1");
    EXPECT_STREQ(error.what(), "scene.toml:7: wind.gust: found 2, expected 0 to 1");
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_STREQ(input_error(ExitCode::kIo, "a\nb", 0, "cannot read", "x", "y").what(),
                 "a\\nb: cannot read: found x, expected y");
}

TEST(NearestName, FindsTheSlipOfTheFinger) {
    const std::vector<std::string> known = {"elevation", "detail_m", "size_m", "mask"};
    EXPECT_EQ(nearest_name("elevaiton", known), "elevation");
    EXPECT_EQ(nearest_name("detail", known), "detail_m");
    EXPECT_EQ(nearest_name("maks", known), "mask");
    EXPECT_EQ(nearest_name("quite_another_thing", known), "");
    EXPECT_EQ(nearest_name(std::string(100000, 'a'), known), "");
}

TEST(Sha256, MatchesThePublishedVectors) {
    EXPECT_EQ(sha256_hex(std::string()),
              "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256_hex(std::string("abc")),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256_hex(std::string("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256_hex(std::string(1000000, 'a')),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    std::set<std::string> all; // the padding's edges: 55, 56, 63, 64 bytes
    for (std::size_t n = 0; n < 130; ++n)
        all.insert(sha256_hex(std::string(n, 'a')));
    EXPECT_EQ(all.size(), 130u);
    EXPECT_EQ(sha256_hex(std::string(64, 'a')),
              "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb");
}

TEST(Hash, IsUniformAndItsStreamsAreIndependent) {
    constexpr int kCount = 100000;
    double sum = 0, product = 0;
    std::set<std::uint64_t> seen;
    for (int i = 0; i < kCount; ++i) {
        const double a = hash_unit(7, 0, i), b = hash_unit(7, 1, i);
        ASSERT_TRUE(a >= 0 && a < 1);
        sum += a;
        product += (a - 0.5) * (b - 0.5);
        seen.insert(hash64(7, 0, i));
    }
    EXPECT_NEAR(sum / kCount, 0.5, 5 / std::sqrt(12.0 * kCount));
    EXPECT_NEAR(product / kCount, 0, 5 / (12 * std::sqrt(double(kCount))));
    EXPECT_EQ(seen.size(), std::size_t(kCount));
    EXPECT_EQ(hash64(1, 2, 3), hash64(1, 2, 3));
    EXPECT_NE(hash64(1, 2, 3), hash64(1, 3, 2));
    EXPECT_NE(hash64(1, 2, 3), hash64(2, 1, 3));
    EXPECT_EQ(hash64(7, 1, 2), 4286928479264937570ull) << "baked sets depend on these bits";
}

TEST(ReadFile, ReadsWholeFilesUpToTheLimit) {
    const TempDir dir;
    put(dir / "ten", "0123456789");
    EXPECT_EQ(get(dir / "ten"), "0123456789");
    EXPECT_EQ(read_file(dir / "ten", 10).size(), 10u);
    expect_error([&] { (void)read_file(dir / "ten", 9); }, ExitCode::kOverLimit,
                 "found 10 bytes, expected at most 9");
    put(dir / "empty", "");
    EXPECT_EQ(get(dir / "empty"), "");
    EXPECT_FALSE(read_text("/proc/self/status", 1 << 16).empty()) << "a file that tells size 0";
    EXPECT_EQ(read_head(dir / "ten", 4).size(), 4u);
    EXPECT_EQ(read_head(dir / "ten", 400).size(), 10u);
    put(dir / "a name\nwith \xc3\xbc", "x");
    EXPECT_EQ(get(dir / "a name\nwith \xc3\xbc"), "x");
}

TEST(ReadFile, RefusesWhatIsNoRegularFile) {
    const TempDir dir;
    const auto read = [](const fs::path& path) { return [=] { (void)read_file(path, 1000); }; };
    expect_error(read(dir / "missing"), ExitCode::kIo,
                 "missing: cannot read: found No such file or directory");
    expect_error(read(dir.path()), ExitCode::kIo, "found a directory, expected a regular file");
    expect_error(read("/dev/zero"), ExitCode::kIo, "found a device");
    fs::create_symlink("loop", dir / "loop");
    expect_error(read(dir / "loop"), ExitCode::kIo, "Too many levels of symbolic links");
    put(dir / "sparse", "");
    fs::resize_file(dir / "sparse", std::uintmax_t{5} << 30);
    expect_error(read(dir / "sparse"), ExitCode::kOverLimit, "found 5368709120 bytes");
}

TEST(ReadFile, DoesNotWaitOnAFifo) {
    const TempDir dir;
    ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
    ::alarm(5); // ends the test program should it block
    expect_error([&] { (void)read_file(dir / "pipe", 10); }, ExitCode::kIo,
                 "found a FIFO, expected a regular file");
    expect_error([&] { (void)read_head(dir / "pipe", 10); }, ExitCode::kIo, "found a FIFO");
    ::alarm(0);
}

TEST(ReadFile, SaysThatPermissionIsMissing) {
    const TempDir dir;
    put(dir / "secret", "x");
    fs::permissions(dir / "secret", fs::perms::none);
    fs::permissions(dir.path(), fs::perms::all);
    const pid_t child = start([&] {
        if (::getuid() == 0 && ::setuid(65534) != 0)
            return 99;
        const Error error = error_of([&] { (void)read_file(dir / "secret", 10); });
        const bool named = std::string(error.what()).find("Permission denied") != std::string::npos;
        return error.code() == ExitCode::kIo && named ? 0 : 1;
    });
    EXPECT_EQ(status_of(child), 0);
}

TEST(WriteFileAtomic, ReplacesTheWholeFile) {
    const TempDir dir;
    write_file_atomic(dir / "out.txt", std::string("first"));
    EXPECT_EQ(get(dir / "out.txt"), "first");
    write_file_atomic(dir / "out.txt", std::string(3000000, 'x'));
    EXPECT_EQ(get(dir / "out.txt"), std::string(3000000, 'x'));
    write_file_atomic(dir / "out.txt", std::string());
    EXPECT_EQ(get(dir / "out.txt"), "");
    write_file_atomic(dir / "a name\nwith \xc3\xbc", std::string("y"));
    EXPECT_EQ(dir.names(), (std::set<std::string>{"out.txt", "a name\nwith \xc3\xbc"}));
}

TEST(WriteFileAtomic, WritesThroughASymbolicLink) {
    const TempDir dir;
    put(dir / "real", "old");
    fs::create_symlink("real", dir / "link");
    write_file_atomic(dir / "link", std::string("new"));
    EXPECT_TRUE(fs::is_symlink(dir / "link"));
    EXPECT_EQ(get(dir / "real"), "new");
}

TEST(WriteFileAtomic, RefusesNamesThatCannotBeFiles) {
    const TempDir dir;
    const auto write = [](const fs::path& path) {
        return [=] { write_file_atomic(path, std::string("x")); };
    };
    fs::create_directory(dir / "directory");
    put(dir / "file", "");
    fs::create_symlink("nowhere", dir / "dangling");
    ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
    const auto before = dir.names();
    expect_error(write(dir / "directory"), ExitCode::kIo,
                 "directory: cannot write: found a directory");
    expect_error(write(dir / "directory/"), ExitCode::kIo, "found the name of a directory");
    expect_error(write(""), ExitCode::kIo, "found an empty name");
    expect_error(write("/dev/full"), ExitCode::kIo, "/dev/full: cannot write: found a device");
    expect_error(write(dir / "pipe"), ExitCode::kIo, "found a FIFO");
    expect_error(write(dir / "dangling"), ExitCode::kIo, "a symbolic link that leads nowhere");
    expect_error(write(dir / "missing/out"), ExitCode::kIo, "expected a directory that exists");
    expect_error(write(dir / "file/out"), ExitCode::kIo, "Not a directory");
    expect_error(write(dir / std::string(300, 'n')), ExitCode::kIo, "File name too long");
    EXPECT_EQ(dir.names(), before);
}

TEST(WriteFileAtomic, RefusesAReadOnlyDirectory) {
    const TempDir dir;
    fs::permissions(dir.path(), fs::perms(0555));
    const pid_t child = start([&] {
        if (::getuid() == 0 && ::setuid(65534) != 0)
            return 99;
        const Error error = error_of([&] { write_file_atomic(dir / "out", std::string("x")); });
        const bool named =
            std::string(error.what()).find("expected a writable directory") != std::string::npos;
        return error.code() == ExitCode::kIo && named ? 0 : 1;
    });
    EXPECT_EQ(status_of(child), 0);
    fs::permissions(dir.path(), fs::perms::owner_all);
}

TEST(WriteFileAtomic, KeepsTheOldFileWhereTheNewOneDoesNotFit) {
    const TempDir dir;
    put(dir / "out.bin", "old");
    const pid_t child = start([&] {
        ::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{65536, 65536};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        const Error error =
            error_of([&] { write_file_atomic(dir / "out.bin", std::string(1 << 20, 'x')); });
        const bool named =
            std::string(error.what()).find("out.bin: cannot write: found File too large") !=
            std::string::npos;
        return error.code() == ExitCode::kIo && named ? 0 : 1;
    });
    EXPECT_EQ(status_of(child), 0);
    EXPECT_EQ(get(dir / "out.bin"), "old");
    EXPECT_EQ(dir.names(), std::set<std::string>{"out.bin"});
}

TEST(WriteFileAtomic, KeepsTheOldFileOnAFullDisk) {
    const TempDir dir;
    if (::mount("tmpfs", dir.path().c_str(), "tmpfs", 0, "size=65536") != 0)
        GTEST_SKIP() << "cannot mount a small file system here: " << std::strerror(errno);
    put(dir / "out.bin", "old");
    expect_error([&] { write_file_atomic(dir / "out.bin", std::string(1 << 20, 'x')); },
                 ExitCode::kIo, "out.bin: cannot write: found No space left on device");
    EXPECT_EQ(get(dir / "out.bin"), "old");
    EXPECT_EQ(dir.names(), std::set<std::string>{"out.bin"});
    EXPECT_EQ(::umount(dir.path().c_str()), 0);
}

TEST(WriteFileAtomic, OneOfTwoWritersWinsWhole) {
    const TempDir dir;
    const auto writer = [&](char letter) {
        return [&dir, letter] {
            for (int i = 0; i < 20; ++i)
                write_file_atomic(dir / "out", std::string(200000, letter));
            return 0;
        };
    };
    const pid_t a = start(writer('a')), b = start(writer('b'));
    EXPECT_EQ(status_of(a), 0);
    EXPECT_EQ(status_of(b), 0);
    const std::string text = get(dir / "out");
    EXPECT_EQ(text, std::string(200000, text.front()));
    EXPECT_EQ(dir.names(), std::set<std::string>{"out"});
}

TEST(PendingOutput, KeepsTheExtensionAndGoesAwayUncommitted) {
    const TempDir dir;
    {
        const PendingOutput pending(dir / "frame.exr", PendingOutput::Kind::kFile);
        EXPECT_EQ(pending.path().extension(), ".exr");
        EXPECT_EQ(pending.path().parent_path(), dir.path());
        put(pending.path(), "half");
    }
    EXPECT_TRUE(dir.names().empty());
}

TEST(PendingOutput, SwapsADirectory) {
    const TempDir dir;
    const auto write_set = [&](const std::string& text) {
        PendingOutput pending(dir / "set/", PendingOutput::Kind::kDirectory);
        put(pending.path() / "set.json", text);
        pending.commit();
    };
    write_set("one");
    EXPECT_EQ(get(dir / "set/set.json"), "one");
    put(dir / "set/old", "");
    write_set("two");
    EXPECT_EQ(get(dir / "set/set.json"), "two");
    EXPECT_FALSE(fs::exists(dir / "set/old"));
    EXPECT_EQ(dir.names(), std::set<std::string>{"set"});
    { const PendingOutput dropped(dir / "set", PendingOutput::Kind::kDirectory); }
    EXPECT_EQ(get(dir / "set/set.json"), "two");
    EXPECT_EQ(dir.names(), std::set<std::string>{"set"});
}

TEST(PendingOutput, DoesNotSwapAwayWhatIsNotOurs) {
    const TempDir dir;
    fs::create_directories(dir / "home/pictures");
    expect_error(
        [&] { const PendingOutput pending(dir / "home", PendingOutput::Kind::kDirectory); },
        ExitCode::kIo, "home: cannot replace this directory: found a directory in it: pictures");
    put(dir / "file", "");
    expect_error(
        [&] { const PendingOutput pending(dir / "file", PendingOutput::Kind::kDirectory); },
        ExitCode::kIo, "found a file, expected the name of a directory");
    EXPECT_EQ(dir.names(), (std::set<std::string>{"home", "file"}));
}

TEST(PendingOutput, SweepsWhatACrashLeftAndNothingElse) {
    const TempDir dir;
    const fs::path dead = dir / ".sward-999999999-5-0.tmp.png",
                   held = dir / ".sward-999999999-5-1.tmp";
    put(dead, "half");
    fs::create_directories(dir / ".sward-999999998-5-0.tmp/part");
    put(held, "");
    const int lock = ::open(held.c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(::flock(lock, LOCK_EX), 0); // its owner lives where we cannot see its process
    for (const char* other :
         {".sward-notes", ".sward-1-2.tmp", ".sward-999999999-5-0.keep", "photo.tmp"})
        put(dir / other, "");
    const PendingOutput alive(dir / "a.png", PendingOutput::Kind::kFile);
    EXPECT_EQ(dir.names(), (std::set<std::string>{held.filename().string(), ".sward-notes",
                                                  ".sward-1-2.tmp", ".sward-999999999-5-0.keep",
                                                  "photo.tmp", alive.path().filename().string()}));
    const pid_t other = start([&] {
        const PendingOutput second(dir / "b.png", PendingOutput::Kind::kFile);
        return fs::exists(alive.path()) ? 0 : 1; // a living process keeps its own
    });
    EXPECT_EQ(status_of(other), 0);
    ::close(lock);
}

TEST(PendingOutput, SurvivesKill9) {
    const TempDir dir;
    put(dir / "out", "old");
    const pid_t child = start([&] {
        const PendingOutput pending(dir / "out", PendingOutput::Kind::kFile);
        put(pending.path(), "half");
        put(dir / "ready", "");
        ::pause();
        return 0;
    });
    wait_for(dir / "ready");
    ::kill(child, SIGKILL);
    EXPECT_EQ(status_of(child), 1000 + SIGKILL);
    EXPECT_EQ(get(dir / "out"), "old");
    EXPECT_EQ(dir.names().size(), 3u);
    write_file_atomic(dir / "out", std::string("new"));
    EXPECT_EQ(dir.names(), (std::set<std::string>{"out", "ready"})) << "swept at the next start";
}

class SignalCleanup : public testing::TestWithParam<int> {};

TEST_P(SignalCleanup, RemovesTemporariesAndTellsTheSignal) {
    const TempDir dir;
    const TempDir signs;
    const pid_t child = start([&] {
        install_signal_cleanup();
        const PendingOutput file(dir / "out.png", PendingOutput::Kind::kFile);
        const PendingOutput set(dir / "set", PendingOutput::Kind::kDirectory);
        put(set.path() / "blades.glb", "half");
        put(signs / "ready", "");
        while (true)
            ::pause();
        return 0;
    });
    wait_for(signs / "ready");
    EXPECT_EQ(dir.names().size(), 2u);
    ::kill(child, GetParam());
    EXPECT_EQ(status_of(child), 128 + GetParam());
    EXPECT_TRUE(dir.names().empty());
}

INSTANTIATE_TEST_SUITE_P(Signals, SignalCleanup, testing::Values(SIGINT, SIGTERM));

TEST(RequireWritable, TellsKindsApart) {
    const TempDir dir;
    fs::create_directory(dir / "set");
    EXPECT_NO_THROW(require_writable(dir / "new.png"));
    EXPECT_NO_THROW(require_writable(dir / "set", PendingOutput::Kind::kDirectory));
    EXPECT_NO_THROW(require_writable(dir / "new/", PendingOutput::Kind::kDirectory));
    expect_error([&] { require_writable(dir / "set"); }, ExitCode::kIo, "found a directory");
    EXPECT_EQ(dir.names(), std::set<std::string>{"set"}) << "a check leaves nothing behind";
}

TEST(ExecutableDirectory, HoldsThisProgram) {
    EXPECT_TRUE(fs::exists(executable_directory() / "unit_base"));
}

TEST(Log, WritesOneLineAMessage) {
    testing::internal::CaptureStderr();
    log_error("a\nb");
    log_warning("w");
    log_info("i");
    log_debug("d");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "error: a\\nb\nwarning: w\ni\n");

    set_verbosity(Verbosity::kQuiet);
    testing::internal::CaptureStderr();
    log_error("e");
    log_info("i");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "error: e\n");

    set_verbosity(Verbosity::kVerbose);
    testing::internal::CaptureStderr();
    log_debug("d");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "d\n");
    set_verbosity(Verbosity::kNormal);
}

TEST(Progress, TellsEachTenthOnceFromAnyThread) {
    testing::internal::CaptureStderr();
    {
        Progress progress("layers", 1000);
        std::vector<std::thread> threads;
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([&] {
                for (int i = 0; i < 300; ++i) // 200 too many: it stays at 100 %
                    progress.advance();
            });
        for (std::thread& thread : threads)
            thread.join();
    }
    std::string expected;
    for (int tenth = 10; tenth <= 100; tenth += 10)
        expected += "layers: " + std::to_string(tenth) + " %\n";
    EXPECT_EQ(testing::internal::GetCapturedStderr(), expected);

    set_verbosity(Verbosity::kQuiet);
    testing::internal::CaptureStderr();
    Progress("quiet", 2).advance(2);
    Progress("nothing to do", 0).advance();
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    set_verbosity(Verbosity::kNormal);
}

TEST(Progress, BarTellsTheTimeLeftAndFitsItsTerminal) {
    EXPECT_EQ(progress_bar("files", 0, 3, 80), "files [..............................]   0 % ");
    EXPECT_EQ(progress_bar("files", 0.25, 10, 80),
              "files [#######.......................]  25 % 30 s left");
    EXPECT_EQ(progress_bar("files", 0.5, 200, 80),
              "files [###############...............]  50 % 3 min 20 s left");
    EXPECT_EQ(progress_bar("files", 0.999, 2, 80).substr(39),
              " 99 % 0 s left"); // not done: not 100
    EXPECT_EQ(progress_bar("files", 1, 7200, 80),
              "files [##############################] 100 % in 2 h 0 min");
    for (std::size_t columns = 0; columns < 90; ++columns)
        EXPECT_LE(progress_bar("layers and slices", 0.3, 12, columns).size() + 1,
                  std::max<std::size_t>(columns, 1));
    EXPECT_EQ(progress_bar("layers", 0.3, 12, 24).find('['), std::string::npos);
    EXPECT_NE(progress_bar("layers", 0.3, 12, 30).find("[#...]"), std::string::npos);
}

} // namespace
} // namespace sward::base
