# cmake -DOUTPUT=file.cpp -DFOLDER=folder "-DSCRIPTS=a.js;b.js" -P EmbedPage.cmake
# Writes a source that defines what compare/report/page_sources.hpp declares.

function(literals result)
  set(all "")
  foreach(name IN LISTS ARGN)
    file(READ "${FOLDER}/${name}" text)
    # A string literal may have 65536 characters by the standard's own minimum.
    string(LENGTH "${text}" length)
    if(length GREATER 65000)
      message(FATAL_ERROR "${name} is too long to embed: split it")
    endif()
    string(APPEND all "\n    R\"tandem_text(${text})tandem_text\"")
  endforeach()
  set(${result} "${all}" PARENT_SCOPE)
endfunction()

literals(template page.html)
literals(style style.css)
literals(script ${SCRIPTS})
file(
  WRITE "${OUTPUT}"
  "#include \"compare/report/page_sources.hpp\"\n\nnamespace tandem::compare {\n\n"
  "std::string_view page_template() {\n  return ${template};\n}\n\n"
  "std::string_view page_style() {\n  return ${style};\n}\n\n"
  "std::string_view page_script() {\n  return ${script};\n}\n\n"
  "}  // namespace tandem::compare\n")
