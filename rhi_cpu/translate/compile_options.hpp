#pragma once

namespace tandem::cpu {

/// How a translated kernel is compiled, by the build and at run time alike; cmake/TandemShaders.cmake reads this list,
/// so each option stands alone on its line. The compiler is g++ or clang++.
inline constexpr const char* compile_options[] = {
    "-std=c++20",          //
    "-O2",                 //
    "-ffp-contract=off",   // a * b + c rounds twice, on every machine
    "-fno-fast-math",      //
    "-fno-math-errno",     // sqrt is one instruction; changes no value
    "-fno-trapping-math",  // nobody reads the exception flags; changes no value
    "-DNDEBUG",            // an index beyond a vector is some component of it, not the end of the process
    "-fwrapv",             // signed integers wrap, as SPIR-V says
    // A shader is one loop over functions that take structures: left as calls they copy those through memory, which
    // costs up to half the speed. g++ inlines this far; clang++ accepts the options and goes by its own rules.
    "--param=max-inline-insns-single=1000",    //
    "--param=max-inline-insns-auto=300",       //
    "--param=large-function-growth=1000",      //
    "--param=large-stack-frame-growth=10000",  //
    "--param=inline-unit-growth=200",          //
    "-fvisibility=hidden",                     // only the entry is exported
    "-w",                                      // generated code is checked by tests, not by warnings
};

}  // namespace tandem::cpu
