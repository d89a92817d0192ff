#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/kernel/subgroups.hpp"

/// Subgroups whose invocations are fibres. Before a subgroup operation an invocation waits until every other one of its
/// subgroup waits too, or has ended. Then those that are the least far go on, together.
namespace tandem::kernel {

/// How far an invocation is: the number of a place in program order; for each loop around it, the number of the loop's
/// place and the round come before that, and for each call the number of the call's place. Positions of one shader
/// compare as words do in a dictionary. Since an invocation's position only grows, those that go on together are all
/// that ever come to that position: the shader reconverges as early as it can.
template <std::uint32_t depth>
using Position = std::array<std::uint32_t, depth>;

/// Whose turn it is in a workgroup of `count` invocations, the subgroups of which are runs of `width` of them; the last
/// may have fewer.
template <std::uint32_t width, std::uint32_t count, std::uint32_t depth>
class Subgroups {
 public:
  Subgroups() { begin_turn(); }

  /// To be called by each fibre when it begins.
  void begin(Fibres& fibres) { fibres_ = &fibres; }

  /// As Turns::barrier.
  void barrier(std::uint32_t index, std::uint32_t place) {
    if constexpr (count > 1) {
      arrive(index, place);
      go_on(index, next(index / width));
    }
  }

  /// As Turns::end.
  std::uint32_t end(std::uint32_t index) {
    arrive(index, ended);
    return next(index / width);
  }

  /// What invocations hand over to each other when they meet.
  struct Slot {
    alignas(8) std::byte value[32];  ///< the largest there is: four doubles
    std::uint32_t source;
  };
  struct Subgroup {
    LaneMask ready = 0;    ///< may go on
    LaneMask waiting = 0;  ///< at a subgroup operation
    LaneMask active = 0;   ///< the last that met
    bool is_done = false;  ///< whether one of them has done what they met for
    const Position<depth>* positions[width];
    Slot slots[width];
  };

  Subgroup& subgroup(std::uint32_t i) { return subgroups_[i]; }

  /// Returns when all have come that ever come to this position; subgroup(i).active are they.
  [[gnu::noinline]] void meet(std::uint32_t index, const Position<depth>& position) {
    Subgroup& own = subgroups_[index / width];
    const LaneMask self = LaneMask{1} << index % width;
    own.positions[index % width] = &position;
    own.waiting |= self;
    own.ready &= ~self;
    if (own.ready == 0) choose(own);
    if ((own.ready & self) == 0) go_on(index, index / width * width + first_lane(own.ready));
  }

 private:
  static constexpr std::uint32_t subgroup_count = (count + width - 1) / width;
  static constexpr std::uint32_t ended = 0, nowhere = ~0u;

  void begin_turn() {
    place_ = nowhere;
    for (std::uint32_t i = 0; i < subgroup_count; ++i) {
      const std::uint32_t left = count - i * width;
      subgroups_[i].ready = lanes_below(left < width ? left : width);
    }
  }

  void arrive(std::uint32_t index, std::uint32_t place) {
    subgroups_[index / width].ready &= ~(LaneMask{1} << index % width);
    if (place_ == nowhere)
      place_ = place;
    else if (place_ != place)
      fibres_->fail(*fibres_);
  }

  /// Makes those ready that are the least far.
  static void choose(Subgroup& subgroup) {
    const Position<depth>* least = nullptr;
    LaneMask chosen = 0;
    for_each_lane(subgroup.waiting, [&](std::uint32_t lane) {
      const Position<depth>& own = *subgroup.positions[lane];
      if (least != nullptr && own == *least) {
        chosen |= LaneMask{1} << lane;
      } else if (least == nullptr || own < *least) {
        least = &own;
        chosen = LaneMask{1} << lane;
      }
    });
    subgroup.ready = subgroup.active = chosen;
    subgroup.waiting &= ~chosen;
    subgroup.is_done = false;
  }

  /// Who goes on after one of subgroup `i` has come to a barrier or has ended; `count` when all have ended.
  [[gnu::noinline]] std::uint32_t next(std::uint32_t i) {
    while (true) {
      Subgroup& subgroup = subgroups_[i];
      if (subgroup.ready == 0 && subgroup.waiting != 0) choose(subgroup);
      if (subgroup.ready != 0) return i * width + first_lane(subgroup.ready);
      if (++i < subgroup_count) continue;
      if (place_ == ended) return count;
      begin_turn();
      i = 0;
    }
  }

  void go_on(std::uint32_t index, std::uint32_t other) {
    if (other != index) fibres_->switch_to(*fibres_, other);
  }

  Fibres* fibres_ = nullptr;
  std::uint32_t place_ = nowhere;  ///< where the invocations of this turn wait that wait at a barrier
  Subgroup subgroups_[subgroup_count];
};

// Operations of Lane::apply and Lane::agree.

template <typename Operation, std::uint32_t width, std::uint32_t cluster = width>
struct Reduction {
  template <typename T>
  static void run(T* values, LaneMask active) {
    kernel::reduce<Operation, width>(values, active, cluster);
  }
};
template <typename Operation, std::uint32_t width>
struct InclusiveScan {
  template <typename T>
  static void run(T* values, LaneMask active) {
    kernel::inclusive_scan<Operation, width>(values, active);
  }
};
template <typename Operation, std::uint32_t width>
struct ExclusiveScan {
  template <typename T>
  static void run(T* values, LaneMask active) {
    kernel::exclusive_scan<Operation, width>(values, active);
  }
};
struct AllOf {
  static bool run(const bool* values, LaneMask active) { return kernel::all_of(values, active); }
};
struct AnyOf {
  static bool run(const bool* values, LaneMask active) { return kernel::any_of(values, active); }
};
struct AllEqual {
  template <typename T>
  static bool run(const T* values, LaneMask active) {
    return kernel::all_equal(values, active);
  }
};
struct Ballot {
  static uvec4 run(const bool* values, LaneMask active) { return kernel::ballot(values, active); }
};
struct ValueOfFirst {
  template <typename T>
  static T run(const T* values, LaneMask active) {
    return kernel::value_of_first(values, active);
  }
};

/// An invocation as a part of its subgroup.
template <std::uint32_t width, std::uint32_t count, std::uint32_t depth>
class Lane {
 public:
  Lane(Subgroups<width, count, depth>& subgroups, std::uint32_t index) : subgroups_(subgroups), index_(index) {}

  std::uint32_t id() const { return index_ % width; }

  /// What the operation that follows has behind the position of the calls around it.
  template <typename... Words>
  Lane& at(Words... words) {
    std::uint32_t i = start_;
    ((position_[i++] = words), ...);
    while (i < depth) position_[i++] = 0;
    return *this;
  }
  /// To be called before and after a call of a function that has subgroup operations.
  template <typename... Words>
  void enter(Words... words) {
    ((position_[start_++] = words), ...);
  }
  void leave(std::uint32_t words) { start_ -= words; }

  /// @return who takes part
  LaneMask meet() {
    if constexpr (is_alone) return 1;
    subgroups_.meet(index_, position_);
    return own().active;
  }

  bool is_elected() { return first_lane(meet()) == id(); }

  // One function for all that a kernel does with values of one type: nothing is gained where each is inlined, and
  // compilers take long.

  /// Operation::run(values, active) changes the values of those that take part.
  template <typename Operation, typename T>
  [[gnu::noinline]] T apply(const T value) {
    if constexpr (is_alone) {
      T values[width] = {value};
      Operation::run(values, LaneMask{1});
      return values[0];
    }
    put(value);
    return finish<T>([&](LaneMask active) {
      T values[width];
      gather(values, active);
      Operation::run(values, active);
      for_each_lane(active,
                    [&](std::uint32_t lane) { std::memcpy(own().slots[lane].value, &values[lane], sizeof(T)); });
    });
  }

  /// What Operation::run(values, active) returns, the same for all that take part.
  template <typename Operation, typename T>
  [[gnu::noinline]] auto agree(const T value) {
    using Result = decltype(Operation::run(&value, LaneMask{1}));
    if constexpr (is_alone) return Result(Operation::run(&value, LaneMask{1}));
    put(value);
    return finish<Result>([&](LaneMask active) {
      T values[width];
      gather(values, active);
      const Result result = Operation::run(values, active);
      for_each_lane(active, [&](std::uint32_t lane) { std::memcpy(own().slots[lane].value, &result, sizeof(Result)); });
    });
  }

  /// The value of lane `source`.
  template <typename T>
  [[gnu::noinline]] T exchange(const T value, std::uint32_t source) {
    if constexpr (is_alone) return source == 0 ? value : T{};
    put(value);
    own().slots[id()].source = source;
    return finish<T>([&](LaneMask active) {
      T values[width];
      gather(values, active);
      std::uint32_t sources[width];
      for_each_lane(active, [&](std::uint32_t lane) { sources[lane] = own().slots[lane].source; });
      kernel::shuffle<width>(values, sources, active);
      for_each_lane(active,
                    [&](std::uint32_t lane) { std::memcpy(own().slots[lane].value, &values[lane], sizeof(T)); });
    });
  }

 private:
  static constexpr bool is_alone = width == 1 || count == 1;

  typename Subgroups<width, count, depth>::Subgroup& own() { return subgroups_.subgroup(index_ / width); }

  template <typename T>
  void put(const T& value) {
    static_assert(sizeof(T) <= sizeof(own().slots[0].value));
    std::memcpy(own().slots[id()].value, &value, sizeof(T));
  }
  template <typename T>
  void gather(T* values, LaneMask active) {
    for_each_lane(active, [&](std::uint32_t lane) { std::memcpy(&values[lane], own().slots[lane].value, sizeof(T)); });
  }
  /// The first that goes on does it for all: by the time that the next one does, a slot may hold something new.
  template <typename Result, typename Compute>
  Result finish(const Compute& compute) {
    const LaneMask active = meet();
    if (!own().is_done) {
      own().is_done = true;
      compute(active);
    }
    Result result;
    std::memcpy(&result, own().slots[id()].value, sizeof(Result));
    return result;
  }

  Subgroups<width, count, depth>& subgroups_;
  std::uint32_t index_;
  std::uint32_t start_ = 0;  ///< words of the calls around
  Position<depth> position_ = {};
};

}  // namespace tandem::kernel
