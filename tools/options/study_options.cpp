#include "tools/options/study_options.hpp"

#include <vector>

#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"

namespace tandem::tools {

void add_study_options(CLI::App& command, StudyOptions& options) {
  add_device(command, options.device, "Device to run on, as listed by 'tandem devices'", "run the study once for each");
  add_whole_number(command, "--threads", options.threads, 0, 4096,
                   "Worker threads of the CPU devices; 0: one per hardware thread");
  command.add_option("--json", options.json, "Write all measurements as JSON")->type_name("FILE");
  command.add_option("--markdown", options.markdown, "Write the tables as Markdown")->type_name("FILE");
}

rhi::DeviceHandle open_study_device(const StudyOptions& options) {
  for (const std::filesystem::path& path : {options.json, options.markdown, options.page})
    if (!path.empty()) check_output_path(path);
  RenderOptions device_options;
  device_options.threads = options.threads;
  return open_device(options.device, device_options);
}

void finish_study(const StudyOptions& options, const StudyTexts& texts) {
  print("{}", texts.markdown);
  std::vector<OutputFile> files;
  const auto add = [&](const std::filesystem::path& file, const std::string& text) {
    if (!file.empty()) files.push_back({file, [&text](const std::filesystem::path& path) { write_text(path, text); }});
  };
  add(options.json, texts.json);
  add(options.markdown, texts.markdown);
  add(options.page, texts.page);
  write_or_rescue(files);
  print_written(files);
}

}  // namespace tandem::tools
