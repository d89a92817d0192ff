#include "tests/support/process.hpp"

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
#include <regex>
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
[[noreturn]] void become(char* const* arguments, char* const* environment, const ProcessOptions& options,
                         const Pipe& output, const Pipe& errors) {
  dup2(output.ends[1], STDOUT_FILENO);
  dup2(errors.ends[1], STDERR_FILENO);
  if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(126);
  if (options.file_size_limit != 0) {
    // Ignored, so that a write beyond the limit fails instead of ending the program.
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {options.file_size_limit, options.file_size_limit};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(126);
  }
  execve(arguments[0], arguments, environment);
  _exit(127);
}

/// As execve wants them.
std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// The variables of this process, but for those that `changed` (NAME=value) has.
std::vector<std::string> with_environment(std::vector<std::string> changed) {
  const std::vector<std::string> before = changed;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    const std::string_view start = text.substr(0, text.find('=') + 1);
    const auto has_name = [&](const std::string& each) { return each.starts_with(start); };
    if (std::ranges::none_of(before, has_name)) changed.emplace_back(text);
  }
  return changed;
}

}  // namespace

std::vector<std::string> words(std::string_view line, std::initializer_list<std::string_view> values) {
  std::vector<std::string> result;
  const std::string_view* value = values.begin();
  std::istringstream stream{std::string(line)};
  for (std::string word; stream >> word;) {
    if (word == "{}" && value == values.end()) throw std::invalid_argument("no value for {} in: " + std::string(line));
    result.push_back(word == "{}" ? std::string(*value++) : word);
  }
  if (value != values.end()) throw std::invalid_argument("more values than {} in: " + std::string(line));
  return result;
}

Outcome run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                    const ProcessOptions& options) {
  std::vector<std::string> all = {program.string()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = with_environment(options.environment);
  const std::vector<char*> argument_pointers = pointers(all), variable_pointers = pointers(variables);

  Pipe output;
  Pipe errors;
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) become(argument_pointers.data(), variable_pointers.data(), options, output, errors);
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

Outcome run_tandem(const std::vector<std::string>& arguments, const ProcessOptions& options) {
  Outcome outcome = run_program(TANDEM_BINARY, arguments, options);
  static const std::regex waiting("tandem: [^\n]*: ([0-9]+ s so far|[0-9]+ % after [0-9]+ s)\n");
  outcome.errors = std::regex_replace(outcome.errors, waiting, "");
  return outcome;
}

Outcome run_in_shell(const std::string& line, ProcessOptions options) {
  const char* const path = std::getenv("PATH");
  options.environment.push_back("PATH=" + std::filesystem::path(TANDEM_BINARY).parent_path().string() + ":" +
                                (path != nullptr ? path : ""));
  return run_program("/bin/sh", {"-c", line}, options);
}

}  // namespace tandem::test
