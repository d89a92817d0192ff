# cmake -DOUTPUT=file.cpp "-DSOURCES=a.comp;b.comp" -P EmbedSources.cmake
# Writes a source that defines tandem::kernels::sources(): the texts of the files.

set(content "#include \"tools/kernels/source.hpp\"\n\nnamespace tandem::kernels {\nnamespace {\n\nconstexpr Source all[] = {\n")
foreach(source IN LISTS SOURCES)
  file(READ "${source}" text)
  cmake_path(GET source STEM stem)
  string(APPEND content "    {\"${stem}\", R\"tandem_text(${text})tandem_text\"},\n")
endforeach()
string(APPEND content "};\n\n}  // namespace\n\nstd::span<const Source> sources() { return all; }\n\n}  // namespace tandem::kernels\n")
file(WRITE "${OUTPUT}" "${content}")
