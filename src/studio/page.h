// The page's files, which are part of the program.
#pragma once

#include <stddef.h>

typedef struct page_file {
    const char *name, *type; // "assets/index-Bx3.js", "text/javascript; charset=utf-8"
    const unsigned char *bytes, *end;
} page_file;

// Written by the build from the page's own build; the first one is index.html.
extern const page_file page_files[];
extern const int page_file_count;
