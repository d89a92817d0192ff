#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <unordered_map>
#include <vector>

#include "program/record/module.hpp"

namespace tandem::program {

using Words = std::vector<std::uint32_t>;

/// An instruction of these operands.
Words encode(spv::Op op, std::span<const std::uint32_t> operands);
Words encode(spv::Op op, std::initializer_list<std::uint32_t> operands);

/// New ids of a module, and what is declared in front of its functions: types that it has already are found, as SPIR-V
/// allows each only once.
class Globals {
 public:
  explicit Globals(const Module& module);

  std::uint32_t new_id() noexcept { return bound_++; }
  std::uint32_t bound() const noexcept { return bound_; }

  std::uint32_t bool_type() { return type(spv::OpTypeBool, {}); }
  /// OpTypeInt or OpTypeFloat. @param is_signed of an integer
  std::uint32_t scalar_type(spv::Op op, std::uint32_t width, bool is_signed);
  std::uint32_t uint_type() { return type(spv::OpTypeInt, {32, 0}); }
  std::uint32_t float_type() { return type(spv::OpTypeFloat, {32}); }
  std::uint32_t uint_vector(std::uint32_t size) { return type(spv::OpTypeVector, {uint_type(), size}); }
  std::uint32_t pointer_type(spv::StorageClass storage, std::uint32_t pointee) {
    return type(spv::OpTypePointer, {static_cast<std::uint32_t>(storage), pointee});
  }
  /// A constant of uint.
  std::uint32_t constant(std::uint32_t value);

  /// A constant uvec3.
  std::uint32_t constant_vector(const std::array<std::uint32_t, 3>& values);

  /// A new global variable.
  std::uint32_t variable(spv::StorageClass storage, std::uint32_t pointee);
  /// The input that is this built-in, of the type with which the module declares it, or a new one.
  std::uint32_t input(spv::BuiltIn built_in, std::uint32_t type);
  /// The type of the components of such an input, which is a vector.
  std::uint32_t input_component(std::uint32_t input);
  /// struct { uint words[]; } as a storage buffer.
  std::uint32_t word_buffer(std::uint32_t set, std::uint32_t binding);
  /// Of the pointers into word_buffer().
  spv::StorageClass buffer_storage() const noexcept { return buffer_storage_; }

  void decorate(std::initializer_list<std::uint32_t> operands);

  const std::vector<Words>& annotations() const noexcept { return annotations_; }
  const std::vector<Words>& declarations() const noexcept { return declarations_; }
  const std::vector<Words>& extensions() const noexcept { return extensions_; }
  /// Variables that an entry point has to list.
  const Words& interface() const noexcept { return interface_; }

 private:
  std::uint32_t type(spv::Op op, std::initializer_list<std::uint32_t> operands);

  const Module& module_;
  std::uint32_t bound_;
  std::uint32_t version_;
  spv::StorageClass buffer_storage_ = spv::StorageClassStorageBuffer;
  std::vector<Words> annotations_, declarations_, extensions_;
  Words interface_;
  std::unordered_map<std::uint32_t, std::uint32_t> constants_;
};

}  // namespace tandem::program
