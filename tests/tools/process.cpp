#include "tests/tools/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace tandem::test {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

struct Pipe {
  Pipe() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe2");
  }
  ~Pipe() {
    close_write_end();
    close(ends[0]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void close_write_end() {
    if (ends[1] >= 0) close(ends[1]);
    ends[1] = -1;
  }

  std::array<int, 2> ends = {-1, -1};  ///< read, write
};

/// Between fork and exec: only functions that are safe there. Does not return.
[[noreturn]] void become_tandem(char* const* arguments, const ProcessOptions& options, const Pipe& output,
                                const Pipe& errors) {
  dup2(output.ends[1], STDOUT_FILENO);
  dup2(errors.ends[1], STDERR_FILENO);
  if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(126);
  if (options.file_size_limit != 0) {
    // Ignored, so that a write beyond the limit fails instead of ending the program.
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {options.file_size_limit, options.file_size_limit};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(126);
  }
  execv(TANDEM_BINARY, arguments);
  _exit(127);
}

}  // namespace

Outcome run_tandem(const std::vector<std::string>& arguments, const ProcessOptions& options) {
  std::vector<std::string> words = {TANDEM_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  Pipe output;
  Pipe errors;
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) become_tandem(pointers.data(), options, output, errors);
  output.close_write_end();
  errors.close_write_end();

  Outcome outcome;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point started = Clock::now();
  bool to_interrupt = options.interrupt_after_ms != 0;
  std::array<pollfd, 2> streams = {pollfd{output.ends[0], POLLIN, 0}, pollfd{errors.ends[0], POLLIN, 0}};
  const std::array<std::string*, 2> texts = {&outcome.output, &outcome.errors};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    if (poll(streams.data(), streams.size(), 50) < 0 && errno != EINTR) fail("poll");
    for (std::size_t index = 0; index < streams.size(); ++index) {
      if (streams[index].fd < 0 || streams[index].revents == 0) continue;
      std::array<char, 4096> bytes;
      const ssize_t count = read(streams[index].fd, bytes.data(), bytes.size());
      if (count > 0) texts[index]->append(bytes.data(), static_cast<std::size_t>(count));
      if (count <= 0) streams[index].fd = -1;
    }
    if (to_interrupt && Clock::now() - started > std::chrono::milliseconds(options.interrupt_after_ms)) {
      kill(child, SIGINT);
      to_interrupt = false;
    }
  }
  int status = 0;
  if (waitpid(child, &status, 0) != child) fail("waitpid");
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return outcome;
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "tandem-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) fail("mkdtemp");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + path.string());
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace tandem::test
