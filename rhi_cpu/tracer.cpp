#include "rhi_cpu/tracer.hpp"

#include <utility>

namespace tandem::cpu {
namespace {

/// The lookup as a tracer wants it, for structures of its own.
template <typename Own>
auto lookup_of(const BuiltBottomLevelLookup& lookup) {
  return [&lookup](std::uint64_t address) -> const Own* {
    const BuiltBottomLevel* found = lookup(address);
    return found != nullptr ? &std::get<Own>(*found) : nullptr;
  };
}

}  // namespace

Tracer::Tracer(Kind kind, rhi::MessageCallback on_message) {
  // A thread count given to Embree would bound oneTBB in the whole program, so builds use what the machine has.
  if (kind == Kind::embree) embree_.emplace(std::move(on_message));
}

BuiltBottomLevel Tracer::build_bottom_level(std::span<const GeometryInput> geometries, rhi::BuildFlags flags,
                                            std::string_view label) const {
  if (embree_) return BottomLevel::build(*embree_, geometries, flags, label);
  return exact::BottomLevel::build(geometries, label);
}

void Tracer::update_bottom_level(BuiltBottomLevel& bottom_level, std::span<const GeometryInput> geometries,
                                 std::string_view label) const {
  if (embree_)
    std::get<BottomLevel>(bottom_level).update(*embree_, geometries, label);
  else
    std::get<exact::BottomLevel>(bottom_level).update(geometries, label);
}

BuiltTopLevel Tracer::build_top_level(std::span<const rhi::InstanceDesc> instances,
                                      const BuiltBottomLevelLookup& lookup, rhi::BuildFlags flags,
                                      std::string_view label) const {
  if (embree_) return TopLevel::build(*embree_, instances, lookup_of<BottomLevel>(lookup), flags, label);
  return exact::TopLevel::build(instances, lookup_of<exact::BottomLevel>(lookup), label);
}

std::uint64_t bytes_of(const BuiltBottomLevel& bottom_level) {
  return std::visit([](const auto& built) { return built.bytes(); }, bottom_level);
}

std::uint64_t bytes_of(const BuiltTopLevel& top_level) {
  return std::visit([](const auto& built) { return built.bytes(); }, top_level);
}

const kernel::TopLevel& view_of(const BuiltTopLevel& top_level) {
  return std::visit([](const auto& built) -> const kernel::TopLevel& { return built.view(); }, top_level);
}

}  // namespace tandem::cpu
