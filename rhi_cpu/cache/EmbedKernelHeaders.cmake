# cmake -DOUTPUT=file.cpp -DROOT=folder "-DHEADERS=a.hpp;b.hpp" -P EmbedKernelHeaders.cmake
# Writes a source that defines tandem::cpu::kernel_headers(): the texts of the headers, which are named relative to ROOT.

set(content "#include \"rhi_cpu/cache/kernel_headers.hpp\"\n\nnamespace tandem::cpu {\nnamespace {\n\nconstexpr KernelHeader headers[] = {\n")
foreach(header IN LISTS HEADERS)
  file(READ "${ROOT}/${header}" text)
  # A string literal may have 65536 characters by the standard's own minimum; a header that long is no header.
  string(LENGTH "${text}" length)
  if(length GREATER 65000)
    message(FATAL_ERROR "${header} is too long to embed: split it")
  endif()
  string(APPEND content "    {\"${header}\", R\"tandem_text(${text})tandem_text\"},\n")
endforeach()
string(APPEND content "};\n\n}  // namespace\n\nstd::span<const KernelHeader> kernel_headers() { return headers; }\n\n}  // namespace tandem::cpu\n")
file(WRITE "${OUTPUT}" "${content}")
