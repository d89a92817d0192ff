#pragma once

#include <stdlib.h>

#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "rhi/message.hpp"

namespace tandem::test {

/// A new folder for one test, removed with all in it at its end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "tandem-test-XXXXXX").string();
    path_ = ::mkdtemp(path.data());
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// An environment variable with another value, or none, as long as the object lives.
class EnvironmentVariable {
 public:
  EnvironmentVariable(std::string name, const std::optional<std::string>& value) : name_(std::move(name)) {
    if (const char* before = std::getenv(name_.c_str())) before_ = before;
    set(value);
  }
  ~EnvironmentVariable() { set(before_); }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  void set(const std::optional<std::string>& value) {
    if (value)
      ::setenv(name_.c_str(), value->c_str(), 1);
    else
      ::unsetenv(name_.c_str());
  }

  std::string name_;
  std::optional<std::string> before_;
};

/// Collects what a device or a cache says.
class Messages {
 public:
  rhi::MessageCallback callback() {
    return [this](const rhi::Message& message) {
      const std::lock_guard lock(mutex_);
      messages_.push_back(message);
    };
  }

  /// How many messages of that severity contain `text`.
  std::size_t count(rhi::Severity severity, const std::string& text) const {
    const std::lock_guard lock(mutex_);
    std::size_t count = 0;
    for (const rhi::Message& message : messages_)
      if (message.severity == severity && message.text.find(text) != std::string::npos) ++count;
    return count;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<rhi::Message> messages_;
};

}  // namespace tandem::test
