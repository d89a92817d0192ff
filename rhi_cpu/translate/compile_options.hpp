#pragma once

namespace tandem::cpu {

/// How a translated kernel is compiled, by the build and at run time alike; cmake/TandemShaders.cmake reads this list,
/// so each option stands alone on its line. The compiler is g++ or clang++.
inline constexpr const char* compile_options[] = {
    "-std=c++20",           //
    "-O2",                  //
    "-ffp-contract=off",    // a * b + c rounds twice, on every machine
    "-fno-fast-math",       //
    "-fno-math-errno",      // sqrt is one instruction; changes no value
    "-fno-trapping-math",   // nobody reads the exception flags; changes no value
    "-fwrapv",              // signed integers wrap, as SPIR-V says
    "-fvisibility=hidden",  // only the entry is exported
    "-w",                   // generated code is checked by tests, not by warnings
};

}  // namespace tandem::cpu
