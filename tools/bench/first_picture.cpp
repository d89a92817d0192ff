#include "tools/bench/first_picture.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <thread>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "base/text_file.hpp"
#include "tools/output/interruption.hpp"

extern char** environ;

namespace tandem::tools {
namespace {

using Clock = std::chrono::steady_clock;

/// A folder for temporary files that goes with this object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "tandem-bench-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw Error(fmt::format("{}: cannot make a folder for temporary files", name));
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

/// A running program, which ends with this object.
class Child {
 public:
  Child(std::vector<std::string> words, const std::filesystem::path& output) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    const int failure = ::posix_spawn(&id_, "/proc/self/exe", &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0)
      throw Error(fmt::format("cannot start 'tandem render': {}", std::generic_category().message(failure)));
  }
  ~Child() {
    if (!is_running_) return;
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Its exit code once it has ended; -1 where a signal ended it.
  std::optional<int> exit_code() {
    int status = 0;
    const pid_t ended = ::waitpid(id_, &status, WNOHANG);
    if (ended == 0 || (ended < 0 && errno == EINTR)) return std::nullopt;
    is_running_ = false;
    return ended > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t id_ = 0;
  bool is_running_ = true;
};

}  // namespace

std::optional<double> first_picture(const Configuration& configuration, const std::string& device,
                                    std::chrono::milliseconds limit) {
  const TemporaryFolder folder;
  std::vector<std::string> words = {"tandem", "render"};
  words.insert(words.end(), configuration.words.begin(), configuration.words.end());
  set_option(words, "--spp", "1");
  words.insert(words.end(), {"--device", device, "-o", (folder.path() / "picture.exr").string()});
  const Clock::time_point start = Clock::now();
  Child child(std::move(words), folder.path() / "output.txt");
  for (;;) {
    const std::optional<int> code = child.exit_code();
    const std::chrono::duration<double, std::milli> taken = Clock::now() - start;
    if (code == 0) return taken.count();
    if (code) {
      std::string sentence = read_text(folder.path() / "output.txt");
      while (sentence.ends_with('\n')) sentence.pop_back();
      throw Error(fmt::format("--first-picture: 'tandem render' on {} failed: {}", device,
                              sentence.substr(sentence.rfind('\n') + 1)));
    }
    if (interrupted()) throw Cancelled();
    if (taken > limit) return std::nullopt;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace tandem::tools
