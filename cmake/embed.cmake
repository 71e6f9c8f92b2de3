# Writes OUTPUT, a C source that holds the files of PAGE. The assembler takes their bytes in: a megabyte of hexadecimal in C would
# take the compiler longer than everything else.
set(types
  html "text/html; charset=utf-8" js "text/javascript; charset=utf-8" css "text/css; charset=utf-8" json "application/json"
  svg "image/svg+xml" png "image/png" webp "image/webp" woff2 "font/woff2" wasm "application/wasm" txt "text/plain; charset=utf-8")
if(NOT EXISTS ${PAGE}/index.html)
  file(WRITE ${PAGE}/index.html "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Auxshell</title>
<h1>The studio's page is not part of this build</h1>
<p>Install Node.js 20.19 or later with npm, remove the build folder, and start again: ./run</p></html>
")
endif()
file(GLOB_RECURSE files RELATIVE ${PAGE} ${PAGE}/*)
list(SORT files)
list(REMOVE_ITEM files index.html)
list(PREPEND files index.html)
set(symbols "")
set(rows "")
set(number 0)
foreach(file IN LISTS files)
  get_filename_component(ending ${file} LAST_EXT)
  string(REPLACE "." "" ending "${ending}")
  list(FIND types "${ending}" place)
  set(type "application/octet-stream")
  if(place GREATER -1)
    math(EXPR place "${place} + 1")
    list(GET types ${place} type)
  endif()
  string(APPEND symbols "FILE(page_${number}, \"${PAGE}/${file}\")\n")
  string(APPEND rows "    {\"${file}\", \"${type}\", page_${number}, page_${number}_end},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT}
"// Written by the build from the studio's page.
#include \"studio/page.h\"

#define FILE(symbol, path) \\
    __asm__(\".section .rodata\\n\" #symbol \":\\n.incbin \\\"\" path \"\\\"\\n\" #symbol \"_end:\\n.byte 0\\n.text\\n\"); \\
    extern const unsigned char symbol[], symbol##_end[];

${symbols}
const page_file page_files[] = {
${rows}};
const int page_file_count = ${number};
")
