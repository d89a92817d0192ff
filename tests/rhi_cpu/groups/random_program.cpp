#include "tests/rhi_cpu/groups/random_program.hpp"

#include <utility>

#include <fmt/format.h>

namespace tandem::cpu::test {

/// Conditions and numbers of a lane are a hash of it, of the node and of the rounds of the loops around.
struct RandomProgram::Node {
  enum class Kind { ballot, branch, for_loop, do_loop, endless_loop, switch_case, call, leave, next_round, end };
  Kind kind;
  std::uint32_t number;  ///< of the node
  std::uint32_t callee = 0;
  bool falls_through = false;  ///< cases of a switch
  bool asks_last = false;      ///< a ballot where a loop goes on
  std::vector<Block> blocks = {};
};

namespace {

using Node = RandomProgram::Node;
using Block = RandomProgram::Block;
using Kind = Node::Kind;
using Mask = std::uint64_t;

constexpr std::uint32_t case_count = 4;

std::uint32_t hash(std::uint32_t lane, std::uint32_t number, std::uint32_t rounds) {
  std::uint32_t x = lane * 0x9e3779b1u + number * 0x85ebca77u + rounds * 0xc2b2ae3du;
  x ^= x >> 15;
  x *= 0x2c1b3c6du;
  return x >> 12;
}

class Generator {
 public:
  explicit Generator(std::uint32_t seed) : random_(seed) {}

  Block block(std::uint32_t depth, bool in_loop, std::uint32_t callees) {
    Block result;
    const std::uint32_t count = 1 + draw() % 2;
    for (std::uint32_t i = 0; i < count; ++i) {
      result.push_back(node(depth, in_loop, callees));
      result.push_back(made(Kind::ballot));
    }
    return result;
  }

 private:
  std::shared_ptr<Node> made(Kind kind) { return std::make_shared<Node>(Node{.kind = kind, .number = ++number_}); }

  std::shared_ptr<Node> node(std::uint32_t depth, bool in_loop, std::uint32_t callees) {
    const std::uint32_t choice = draw() % 16;
    if (depth == 0 || choice == 0) {
      if (in_loop && draw() % 2 == 0) return made(draw() % 2 == 0 ? Kind::leave : Kind::next_round);
      return made(draw() % 4 == 0 ? Kind::end : Kind::ballot);
    }
    if (choice < 3 && callees > 0) {
      std::shared_ptr<Node> result = made(Kind::call);
      result->callee = draw() % callees;
      return result;
    }
    const Kind kind = choice < 8    ? Kind::branch
                      : choice < 10 ? Kind::for_loop
                      : choice < 12 ? Kind::do_loop
                      : choice < 14 ? Kind::endless_loop
                                    : Kind::switch_case;
    std::shared_ptr<Node> result = made(kind);
    const bool is_loop = kind != Kind::branch && kind != Kind::switch_case;
    const std::uint32_t blocks = kind == Kind::branch ? 1 + draw() % 2 : kind == Kind::switch_case ? case_count : 1;
    for (std::uint32_t i = 0; i < blocks; ++i)
      result->blocks.push_back(block(depth - 1, is_loop || (in_loop && kind == Kind::branch), callees));
    result->falls_through = draw() % 2 == 0;
    result->asks_last = draw() % 2 == 0;
    return result;
  }

  std::uint32_t draw() { return static_cast<std::uint32_t>(random_()); }

  std::mt19937 random_;
  std::uint32_t number_ = 0;
};

/// GLSL of a block; `rounds` is the expression of the rounds around it.
std::string text(const Block& block, const std::string& name, const std::string& rounds) {
  std::string result;
  for (const auto& node : block) {
    const auto draw = [&](const std::string& inner_rounds) {
      return fmt::format("draw(lane, {}u, {})", node->number, inner_rounds);
    };
    const auto inner = [&](std::size_t i, const std::string& inner_rounds) {
      return text(node->blocks[i], name, inner_rounds);
    };
    const std::string round = fmt::format("i{}", node->number);
    const std::string inner_rounds = fmt::format("({} * 5u + {})", rounds, round);
    const std::string ask = fmt::format("mix_in(h, {}u)", node->number);
    switch (node->kind) {
      case Kind::ballot:
        result += ask + ";\n";
        break;
      case Kind::branch:
        result += fmt::format("if (({} & 1u) != 0u) {{\n{}}}\n", draw(rounds), inner(0, rounds));
        if (node->blocks.size() > 1) result += fmt::format("else {{\n{}}}\n", inner(1, rounds));
        break;
      case Kind::for_loop:
        result += fmt::format("for (uint {0} = 0u; {0} < {1} % 4u; {0}++{2}) {{\n{3}}}\n", round, draw(rounds),
                              node->asks_last ? ", " + ask : "", inner(0, inner_rounds));
        break;
      case Kind::do_loop:
        result += fmt::format("{{ uint {0} = 0u; do {{\n{1}}} while ({2}++{0} < {3} % 4u); }}\n", round,
                              inner(0, inner_rounds), node->asks_last ? ask + " && " : "", draw(rounds));
        break;
      case Kind::endless_loop:
        result += fmt::format("for (uint {0} = 0u;; ++{0}) {{\nif ({0} > {1} % 4u) {{ {2}break; }}\n{3}}}\n", round,
                              draw(rounds), node->asks_last ? ask + "; " : "", inner(0, inner_rounds));
        break;
      case Kind::switch_case:
        result += fmt::format("switch ({} % {}u) {{\n", draw(rounds), case_count);
        for (std::uint32_t i = 0; i < case_count; ++i)
          result += fmt::format("{}\n{}{}", i + 1 == case_count ? "default:" : fmt::format("case {}u:", i),
                                inner(i, rounds), node->falls_through && i % 2 == 0 ? "" : "break;\n");
        result += "}\n";
        break;
      case Kind::call:
        result += fmt::format("h = h * 3u + {}{}(lane);\n", name, node->callee);
        break;
      case Kind::leave:
        result += fmt::format("if ({} % 3u == 0u) break;\n", draw(rounds));
        break;
      case Kind::next_round:
        result += fmt::format("if ({} % 3u == 0u) continue;\n", draw(rounds));
        break;
      case Kind::end:
        result += fmt::format("if ({} % 5u == 0u) return h;\n", draw(rounds));
        break;
    }
  }
  return result;
}

/// All lanes of a subgroup at once.
class Machine {
 public:
  Machine(const std::vector<Block>& functions, std::uint32_t count, std::uint32_t first)
      : functions_(functions), count_(count), first_(first) {}

  std::vector<std::uint32_t> call(std::size_t function, Mask active) {
    const std::vector<std::uint32_t> outer = std::exchange(h_, std::vector<std::uint32_t>(count_, 1));
    const Mask outer_returned = std::exchange(returned_, Mask{0});
    Mask left = 0, next = 0;
    run(functions_[function], active, 0, left, next);
    returned_ = outer_returned;
    return std::exchange(h_, outer);
  }

 private:
  template <typename Condition>
  Mask lanes(Mask active, const Condition& condition) const {
    Mask result = 0;
    for (std::uint32_t lane = 0; lane < count_; ++lane)
      if ((active >> lane & 1) != 0 && condition(first_ + lane)) result |= Mask{1} << lane;
    return result;
  }

  void ask(Mask active, std::uint32_t number) {
    for (std::uint32_t lane = 0; lane < count_; ++lane)
      if ((active >> lane & 1) != 0) h_[lane] = h_[lane] * 31 + static_cast<std::uint32_t>(active) + number * 7;
  }

  /// @return who goes on behind the block. Those that leave the loop or go on with its next round are added to `left`
  /// and `next`.
  Mask run(const Block& block, Mask active, std::uint32_t rounds, Mask& left, Mask& next) {
    for (const auto& node : block) {
      if (active == 0) return 0;
      active = run(*node, active, rounds, left, next);
    }
    return active;
  }

  Mask run(const Node& node, Mask active, std::uint32_t rounds, Mask& left, Mask& next) {
    const auto draw = [&](std::uint32_t lane) { return hash(lane, node.number, rounds); };
    switch (node.kind) {
      case Kind::ballot:
        ask(active, node.number);
        return active;
      case Kind::branch: {
        const Mask taken = lanes(active, [&](std::uint32_t lane) { return (draw(lane) & 1) != 0; });
        Mask result = run(node.blocks[0], taken, rounds, left, next);
        if (node.blocks.size() == 1) return result | (active & ~taken);
        return result | run(node.blocks[1], active & ~taken, rounds, left, next);
      }
      case Kind::switch_case: {
        Mask result = 0, falling = 0;
        for (std::uint32_t i = 0; i < case_count; ++i) {
          Mask here = lanes(active, [&](std::uint32_t lane) { return draw(lane) % case_count == i; }) | falling;
          here = run(node.blocks[i], here, rounds, left, next);
          const bool falls = node.falls_through && i % 2 == 0;
          falling = falls ? here : 0;
          if (!falls) result |= here;
        }
        return result | falling;
      }
      case Kind::for_loop:
      case Kind::do_loop:
      case Kind::endless_loop:
        return run_loop(node, active, rounds);
      case Kind::call: {
        const std::vector<std::uint32_t> values = call(node.callee, active);
        lanes(active, [&](std::uint32_t lane) {
          h_[lane - first_] = h_[lane - first_] * 3 + values[lane - first_];
          return false;
        });
        return active;
      }
      case Kind::leave:
      case Kind::next_round: {
        const Mask going = lanes(active, [&](std::uint32_t lane) { return draw(lane) % 3 == 0; });
        (node.kind == Kind::leave ? left : next) |= going;
        return active & ~going;
      }
      case Kind::end: {
        const Mask going = lanes(active, [&](std::uint32_t lane) { return draw(lane) % 5 == 0; });
        returned_ |= going;
        return active & ~going;
      }
    }
    return active;
  }

  Mask run_loop(const Node& node, Mask active, std::uint32_t rounds) {
    const auto limit = [&](std::uint32_t lane) { return hash(lane, node.number, rounds) % 4; };
    const Mask entered = active;
    for (std::uint32_t i = 0; active != 0; ++i) {
      Mask left = 0, next = 0;
      if (node.kind == Kind::for_loop) active = lanes(active, [&](std::uint32_t lane) { return i < limit(lane); });
      if (node.kind == Kind::endless_loop) {
        const Mask done = lanes(active, [&](std::uint32_t lane) { return i > limit(lane); });
        if (node.asks_last && done != 0) ask(done, node.number);
        active &= ~done;
      }
      active = run(node.blocks[0], active, rounds * 5 + i, left, next) | next;
      if (active == 0) break;
      if (node.asks_last && node.kind != Kind::endless_loop) ask(active, node.number);
      if (node.kind == Kind::do_loop) active = lanes(active, [&](std::uint32_t lane) { return i + 1 < limit(lane); });
    }
    return entered & ~returned_;
  }

  const std::vector<Block>& functions_;
  std::uint32_t count_, first_;
  std::vector<std::uint32_t> h_;  ///< of each lane, in the function that runs
  Mask returned_ = 0;             ///< from it
};

}  // namespace

RandomProgram::RandomProgram(std::uint32_t seed, std::uint32_t function_count) {
  Generator generator(seed);
  for (std::uint32_t i = 0; i < function_count; ++i)
    functions_.push_back(generator.block(i + 1 == function_count ? 3 : 1, false, i));
}

std::string RandomProgram::glsl(const std::string& name) const {
  std::string result;
  for (std::size_t i = 0; i < functions_.size(); ++i)
    result += fmt::format("uint {}{}(uint lane) {{\nuint h = 1u;\n{}return h;\n}}\n", name,
                          i + 1 == functions_.size() ? "" : std::to_string(i), text(functions_[i], name, "0u"));
  return result;
}

std::vector<std::uint32_t> RandomProgram::results(std::uint32_t count, std::uint32_t first) const {
  return Machine(functions_, count, first).call(functions_.size() - 1, (Mask{1} << count) - 1);
}

}  // namespace tandem::cpu::test
