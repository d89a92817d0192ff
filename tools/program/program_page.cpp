#include "tools/program/program_page.hpp"

#include <fmt/format.h>

#include <span>
#include <string_view>
#include <utility>

#include "base/base64.hpp"
#include "base/error.hpp"
#include "compare/report/page_sources.hpp"
#include "pathtracer/image/image_codec.hpp"
#include "program/data/texels.hpp"
#include "program/explain/source.hpp"
#include "program/explain/text.hpp"
#include "program/explain/value_text.hpp"
#include "tools/output/run_record.hpp"
#include "tools/output/xml_text.hpp"
#include "tools/program/contents.hpp"
#include "tools/program/difference_map.hpp"

namespace tandem::tools::program_run {
namespace {

/// Beside that of the pages of scenes.
constexpr std::string_view own_style = R"(
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; margin: .8rem 0 0; }
.pictures figure { margin: 0; }
.pictures img { display: block; width: 20rem; max-width: 100%; image-rendering: pixelated; background: #000; }
figcaption { color: var(--quiet); font-size: .87rem; max-width: 20rem; }
pre { overflow-x: auto; font: .86rem/1.45 var(--code); margin: 0; }
.mismatch { color: var(--bad); font-weight: 600; }
td.code { font-family: var(--code); font-size: .86rem; }
)";

constexpr std::string_view scale_text =
    "Relative difference: black equal bits, dark blue up to 1e-6, blue 1e-5, cyan 1e-4, green 1e-3, yellow 1e-2, red "
    "1e-1, white from 1 on, magenta a NaN or an infinity in one alone";

std::vector<std::byte> png_of(const DifferenceMap& map) {
  return pathtracer::encode_png(map.width, map.height, map.rgb, {});
}

std::string picture(const std::vector<std::byte>& png, std::string_view name, const std::string& caption) {
  return fmt::format("<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{2}</figcaption></figure>",
                     xml_text(name), base64(png), xml_text(caption));
}

class Page {
 public:
  explicit Page(const ProgramPage& contents) : contents_(contents) {}

  std::string text() {
    begin();
    add_verdict();
    add_resources();
    if (contents_.explanation != nullptr) add_explanation(*contents_.explanation);
    add("<footer><p>{}, tandem {}</p><p><code>{}</code></p></footer>\n</body>\n</html>\n", date_text(), TANDEM_VERSION,
        xml_text(command_line()));
    return std::move(html_);
  }

 private:
  template <typename... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(html_), format, std::forward<Arguments>(arguments)...);
  }

  void begin() {
    add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
        "content=\"width=device-width\">\n<title>{0}</title>\n<style>{1}{2}</style>\n</head>\n<body>\n"
        "<p class=\"kicker\">Tandem</p>\n<h1>{0}</h1>\n",
        xml_text(fmt::format("{}: {} against {}", contents_.input, contents_.a.name, contents_.b.name)),
        compare::page_style(), own_style);
  }

  void add_verdict() {
    const char* const state = contents_.agrees ? "agree" : contents_.is_wrong ? "differ" : "explained";
    add("<div class=\"cards\"><div class=\"card {}\"><h2>Verdict</h2><p class=\"lead\"><strong class=\"word\" "
        "id=\"verdict\">{}</strong></p></div>\n<div class=\"card\"><h2>Devices</h2><table><tbody>",
        state, xml_text(contents_.verdict));
    for (const auto& [side, device] : {std::pair("a", &contents_.a), std::pair("b", &contents_.b)})
      add("<tr><th>{}</th><td>{}</td><td>{}</td><td>{}</td></tr>", side, xml_text(device->name),
          xml_text(device->description), xml_text(device->driver));
    add("</tbody></table></div></div>\n");
  }

  void add_resources() {
    add("<section class=\"card\"><h2>Buffers and images</h2><div class=\"scroll\"><table id=\"resources\">\n"
        "<thead><tr><th>name</th><th>values</th><th>bit-equal</th><th>within {} ulp or {:g} relative</th><th>largest "
        "ulp</th><th>relative</th><th>absolute</th><th>NaN in a, b alone</th></tr></thead>\n<tbody>\n",
        contents_.tolerance.ulp, contents_.tolerance.relative);
    for (const auto& [position, values] : contents_.comparisons)
      add("<tr{}><th>{}</th><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td "
          "class=\"number\">{}</td><td class=\"number\">{:.3g}</td><td class=\"number\">{:.3g}</td><td "
          "class=\"number\">{}, {}</td></tr>\n",
          values.agrees() ? "" : " class=\"changed\"", xml_text(contents_.built.resources[position].key),
          values.scalars, values.bit_equal, values.within, values.largest_ulp, values.largest_relative,
          values.largest_absolute, values.nan_a, values.nan_b);
    add("</tbody></table></div></section>\n");
    for (std::size_t i = 0; i < contents_.comparisons.size(); ++i) add_resource(i);
  }

  void add_resource(std::size_t i) {
    const auto& [position, values] = contents_.comparisons[i];
    const ResourcePictures& pictures = contents_.pictures[i];
    if (!values.first && pictures.a.empty()) return;
    const Resource& resource = contents_.built.resources[position];
    add("<section class=\"card resource\"><h2>{}</h2>", xml_text(resource.key));
    if (values.first) {
      add("<table><thead><tr><th></th><th>value</th><th>a</th><th>b</th><th>ulp</th><th>relative</th></tr></thead>"
          "<tbody>");
      add_difference("first", resource, *values.first);
      if (values.disagreed && values.disagreed->index != values.first->index)
        add_difference("first beyond the tolerance", resource, *values.disagreed);
      if (values.worst && values.worst->index != values.first->index) add_difference("worst", resource, *values.worst);
      add("</tbody></table>");
    }
    add("<div class=\"pictures\">");
    if (!pictures.a.empty())
      html_ += picture(pictures.a, "a", contents_.a.name) + picture(pictures.b, "b", contents_.b.name);
    if (!pictures.difference.empty()) html_ += picture(pictures.difference, "difference", pictures.scale);
    add("</div></section>\n");
  }

  void add_difference(std::string_view which, const Resource& resource, const program::Difference& difference) {
    add("<tr><th>{}</th><td class=\"code\">{}</td><td class=\"value\">{}</td><td class=\"value\">{}</td><td "
        "class=\"number\">{}</td><td class=\"number\">{:.3g}</td></tr>",
        which, xml_text(resource.prefix + difference.path), xml_text(difference.a), xml_text(difference.b),
        difference.ulp, difference.relative);
  }

  void add_explanation(const program::Explanation& explanation) {
    const program::ExplanationNames names = {.a = contents_.a.name, .b = contents_.b.name, .input = contents_.input};
    add("<section class=\"card\"><h2>Why</h2><p>Instructions that give other results for the same operands, over {} "
        "values of {} recorded invocations of {}.</p>\n<div class=\"scroll\"><table id=\"instructions\"><thead><tr>"
        "<th>class</th><th>line</th><th>instruction</th><th>differ</th><th>a</th><th>b</th><th>why</th></tr></thead>"
        "<tbody>\n",
        explanation.lockstep.values, explanation.a.request.invocations.size(), explanation.launched);
    for (const program::Site& site : explanation.lockstep.sites) add_site(site);
    add("</tbody></table></div></section>\n<details open><summary>The explanation in text</summary>\n<pre "
        "id=\"explanation\">{}</pre></details>\n",
        xml_lines(program::explanation_text(explanation, contents_.built.job, names)));
  }

  void add_site(const program::Site& site) {
    const program::SourcePlace place = program::source_of(site.shader->module, site.instruction);
    const program::Judgement& judgement = site.example.judgement;
    const bool is_wrong = judgement.cause == program::Cause::mismatch;
    add("<tr><td{}>{}</td><td class=\"code\">{}:{}<br>{}</td><td class=\"code\">{}</td><td class=\"number\">{} of "
        "{}</td><td class=\"value\">{}</td><td class=\"value\">{}</td><td>{}</td></tr>\n",
        is_wrong ? " class=\"mismatch\"" : "", program::name_of(judgement.cause),
        xml_text(place.file.empty() ? site.shader->name : place.file), place.line, xml_text(place.text),
        xml_text(program::describe_instruction(site.shader->module, site.instruction)), site.differences,
        site.executions, xml_text(program::value_text(site.example.a)), xml_text(program::value_text(site.example.b)),
        xml_text(judgement.reason));
  }

  /// xml_text of each line: it writes line breaks as references, which a <pre> shows as well, but nobody can read.
  static std::string xml_lines(const std::string& text) {
    std::string result;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      result += xml_text(std::string_view(text).substr(begin, end - begin)) + "\n";
      begin = end + 1;
    }
    return result;
  }

  const ProgramPage& contents_;
  std::string html_;
};

}  // namespace

ResourcePictures pictures_of(const BuiltJob& built, std::size_t position, const Contents& a, const Contents& b) {
  const Resource& resource = built.resources[position];
  const program::ValueType type = type_of(built, resource);
  ResourcePictures pictures;
  if (!resource.is_image) {
    if (a[position] == b[position]) return pictures;
    const DifferenceMap map = difference_map(type, a[position], b[position]);
    pictures.difference = png_of(map);
    pictures.scale = fmt::format(
        "{}. A cell is {}; {} of them in a row.", scale_text,
        map.scalars_of_cell == 1 ? "one number" : fmt::format("{} numbers", map.scalars_of_cell), map.width);
    return pictures;
  }
  const rhi::TextureDesc& desc = built.job.images[resource.index].desc;
  if (program::has_plain_components(desc.format)) {
    pictures.a = encode_picture("a.png", desc, a[position]);
    pictures.b = encode_picture("b.png", desc, b[position]);
  }
  if (a[position] == b[position]) return pictures;
  const std::uint32_t height = rhi::side_count(desc.dimension) == 1 ? 1 : desc.size[1];
  const program::ValueType texel = program::texel_type(desc.format);
  const std::uint64_t components = program::scalar_count(texel, texel.size);
  pictures.difference = png_of(difference_map(type, a[position], b[position], {desc.size[0], height}, components));
  pictures.scale = fmt::format("{}. Level 0{}.", scale_text, desc.size[2] > 1 ? ", layer 0" : "");
  return pictures;
}

std::string program_page(const ProgramPage& contents) { return Page(contents).text(); }

}  // namespace tandem::tools::program_run
