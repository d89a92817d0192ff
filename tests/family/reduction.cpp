#include "tests/family/reduction.hpp"

#include <algorithm>
#include <optional>

namespace tandem::family {
namespace {

class Reducer {
 public:
  Reducer(ShaderTree shader, const std::function<bool(const ShaderTree&)>& fails, std::size_t limit)
      : shader_(std::move(shader)), fails_(fails), left_(limit) {}

  ShaderTree run() {
    for (bool smaller = true; smaller && left_ > 0;) {
      smaller = remove_functions();
      smaller |= remove_statements();
      smaller |= simplify_expressions();
    }
    return std::move(shader_);
  }

 private:
  bool accept(ShaderTree candidate) {
    if (left_ == 0) return false;
    --left_;
    if (!fails_(candidate)) return false;
    shader_ = std::move(candidate);
    return true;
  }

  bool remove_functions() {
    bool smaller = false;
    for (std::size_t i = shader_.functions.size() - 1; i-- > 0;) {
      ShaderTree candidate = shader_;
      candidate.functions.erase(candidate.functions.begin() + static_cast<std::ptrdiff_t>(i));
      smaller |= accept(std::move(candidate));
    }
    return smaller;
  }

  /// Calls `change` with the list of the number. False when there is none.
  static bool with_list(ShaderTree& shader, std::size_t number,
                        const std::function<void(std::vector<Statement>&)>& change) {
    std::vector<Statement>* found = nullptr;
    for_each_list(shader, [&](std::vector<Statement>& list) {
      if (number-- == 0) found = &list;
    });
    if (found != nullptr) change(*found);
    return found != nullptr;
  }

  bool remove_statements() {
    bool smaller = false;
    for (std::size_t number = 0;; ++number) {
      std::size_t size = 0;
      if (!with_list(shader_, number, [&](auto& list) { size = list.size(); })) return smaller;
      for (std::size_t length = std::max<std::size_t>(size / 2, 1); length > 0; length /= 2)
        for (std::size_t end = size; end >= length && end > 0;) {
          const std::size_t begin = end - length;
          ShaderTree candidate = shader_;
          with_list(candidate, number, [&](auto& list) {
            list.erase(list.begin() + static_cast<std::ptrdiff_t>(begin),
                       list.begin() + static_cast<std::ptrdiff_t>(std::min(end, list.size())));
          });
          if (accept(std::move(candidate))) {
            smaller = true;
            size -= length;
          }
          end = begin;
        }
      for (std::size_t i = size; i-- > 0;) smaller |= unwrap(number, i);
    }
  }

  /// A statement's block in its place.
  bool unwrap(std::size_t number, std::size_t index) {
    std::size_t blocks = 0;
    with_list(shader_, number, [&](auto& list) { blocks = list[index].blocks.size(); });
    for (std::size_t k = 0; k < blocks; ++k) {
      ShaderTree candidate = shader_;
      with_list(candidate, number, [&](auto& list) {
        std::vector<Statement> inner = std::move(list[index].blocks[k]);
        const auto place = list.erase(list.begin() + static_cast<std::ptrdiff_t>(index));
        list.insert(place, inner.begin(), inner.end());
      });
      if (accept(std::move(candidate))) return true;
    }
    return false;
  }

  bool simplify_expressions() {
    bool smaller = false;
    for (std::size_t number = 0;; ++number) {
      const auto find = [&](ShaderTree& shader) {
        Expression* found = nullptr;
        std::size_t left = number;
        for_each_expression(shader, [&](Expression& each) {
          if (left-- == 0) found = &each;
        });
        return found;
      };
      const Expression* expression = find(shader_);
      if (expression == nullptr) return smaller;
      std::vector<Expression> simpler = parts_of(*expression);
      for (Expression& each : simpler) {
        ShaderTree candidate = shader_;
        *find(candidate) = each;
        if (!accept(std::move(candidate))) continue;
        smaller = true;
        break;
      }
    }
  }

  static void collect(const Expression& from, const Type& type, std::vector<Expression>& found) {
    for (const Expression& part : from.parts) {
      if (part.type == type) found.push_back(part);
      collect(part, type, found);
    }
  }

  static std::vector<Expression> parts_of(const Expression& expression) {
    std::vector<Expression> found;
    if (expression.parts.empty()) return found;
    const Type& type = expression.type;
    if (type.is_scalar()) {
      if (type.scalar == Scalar::boolean) {
        found.push_back({type, "true"});
        found.push_back({type, "false"});
      } else {
        found.push_back({type, name_of(type) + "(1)"});
      }
    } else if (!type.is_array() && !type.is_struct()) {
      found.push_back({type, name_of(type) + "(1)"});
    }
    collect(expression, type, found);
    return found;
  }

  ShaderTree shader_;
  const std::function<bool(const ShaderTree&)>& fails_;
  std::size_t left_;
};

}  // namespace

ShaderTree reduced(ShaderTree shader, const std::function<bool(const ShaderTree&)>& fails, std::size_t limit) {
  return Reducer(std::move(shader), fails, limit).run();
}

}  // namespace tandem::family
