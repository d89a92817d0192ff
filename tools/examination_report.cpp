#include "tools/examination_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace tandem::tools {
namespace {

using compare::Ruling;
using pathtracer::RayKind;

/// Disputes that the table lists; the JSON has all.
constexpr std::size_t most_listed = 10;

std::string answer_text(RayKind kind, std::uint32_t answer, std::uint32_t triangle_count) {
  if (kind == RayKind::occlusion) return answer != 0 ? "occluded" : "free";
  if (answer == pathtracer::no_triangle) return "nothing";
  return answer < triangle_count ? fmt::format("triangle {}", answer)
                                 : fmt::format("sphere {}", answer - triangle_count);
}

std::string sentence(const compare::JudgedDispute& judged, std::uint32_t triangle_count) {
  const compare::Dispute& dispute = judged.dispute;
  const auto text = [&](std::uint32_t answer) { return answer_text(dispute.ray.kind, answer, triangle_count); };
  return fmt::format("pixel {},{} sample {} ray {}: a says {}, b says {}, exact is {}: {}", dispute.path.pixel.x,
                     dispute.path.pixel.y, dispute.path.sample, dispute.ray_index, text(dispute.answer_a),
                     text(dispute.answer_b), text(judged.judgement.exact_answer),
                     compare::name(judged.judgement.ruling));
}

nlohmann::ordered_json answer_json(RayKind kind, std::uint32_t answer) {
  if (kind == RayKind::occlusion) return answer != 0;
  if (answer == pathtracer::no_triangle) return nullptr;
  return answer;
}

}  // namespace

std::string table(const compare::Examination& examination, const std::string& arbiter) {
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<18}{}\n", name, value);
  };
  line("arbiter", fmt::format("{}, {} of {} differing pixels examined", arbiter, examination.examined_pixels,
                              examination.differing_pixels));
  line("disputed rays",
       fmt::format("{}: a is right in {}, b in {}, neither in {}, {} are ties within rounding",
                   examination.disputes.size(), examination.count(Ruling::a_right), examination.count(Ruling::b_right),
                   examination.count(Ruling::both_wrong), examination.count(Ruling::tie)));
  line("other paths",
       fmt::format("{} part by the rounding of a ray, {} by their length; {} pixels differ in their sums alone",
                   examination.parted_by_rounding, examination.parted_by_length, examination.unparted_pixels));
  // Those that matter first.
  std::vector<compare::JudgedDispute> listed = examination.disputes;
  std::stable_partition(listed.begin(), listed.end(),
                        [](const auto& each) { return each.judgement.ruling != Ruling::tie; });
  listed.resize(std::min(listed.size(), most_listed));
  for (const compare::JudgedDispute& judged : listed) line("", sentence(judged, examination.triangle_count));
  if (listed.size() < examination.disputes.size())
    line("", fmt::format("and {} more", examination.disputes.size() - listed.size()));
  return text;
}

nlohmann::ordered_json to_json(const compare::Examination& examination, const std::string& arbiter) {
  nlohmann::ordered_json json = {{"device", arbiter},
                                 {"triangles", examination.triangle_count},  // answers from this number on are spheres
                                 {"differing_pixels", examination.differing_pixels},
                                 {"examined_pixels", examination.examined_pixels},
                                 {"parted_by_dispute", examination.parted_by_dispute},
                                 {"parted_by_rounding", examination.parted_by_rounding},
                                 {"parted_by_length", examination.parted_by_length},
                                 {"unparted_pixels", examination.unparted_pixels},
                                 {"a_right", examination.count(Ruling::a_right)},
                                 {"b_right", examination.count(Ruling::b_right)},
                                 {"both_wrong", examination.count(Ruling::both_wrong)},
                                 {"ties", examination.count(Ruling::tie)},
                                 {"disputes", nlohmann::ordered_json::array()}};
  for (const compare::JudgedDispute& judged : examination.disputes) {
    const compare::Dispute& dispute = judged.dispute;
    const pathtracer::TracedRay& ray = dispute.ray;
    json["disputes"].push_back({{"pixel", {dispute.path.pixel.x, dispute.path.pixel.y}},
                                {"sample", dispute.path.sample},
                                {"ray", dispute.ray_index},
                                {"kind", ray.kind == RayKind::closest ? "closest" : "occlusion"},
                                {"origin", {ray.origin.x, ray.origin.y, ray.origin.z}},
                                {"direction", {ray.direction.x, ray.direction.y, ray.direction.z}},
                                {"t_max", ray.t_max},
                                {"a", answer_json(ray.kind, dispute.answer_a)},
                                {"b", answer_json(ray.kind, dispute.answer_b)},
                                {"exact", answer_json(ray.kind, judged.judgement.exact_answer)},
                                {"ruling", compare::name(judged.judgement.ruling)}});
  }
  return json;
}

}  // namespace tandem::tools
