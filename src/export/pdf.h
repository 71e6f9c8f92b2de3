// The frame of a PDF file (ISO 32000-1, version 1.4): pages in a row, each with its content in deflated streams. Libraries draw and
// deflate page by page; here content comes ready made, by as many threads as there are.
#pragma once

#include "export/writing.h"

typedef struct ax_pdf {
    FILE* out;
    long long offset;
    int object_count, object_room, page_count, page_room;
    long long* objects; // where object k + 1 begins
    int* pages;
} ax_pdf;

// Content on its way: `bytes` is owned.
typedef struct ax_pdf_stream {
    unsigned char* bytes;
    size_t size;
} ax_pdf_stream;

ax_status ax_pdf_open(ax_pdf* pdf, const char* path, ax_error* error);
// A page of width x height mm; its streams are the next ones to be added.
void ax_pdf_page(ax_pdf* pdf, double width, double height, int streams);
// Deflates what a writer has kept, and frees it. Thread safe.
ax_pdf_stream ax_pdf_deflate(ax_writer* content);
void ax_pdf_add(ax_pdf* pdf, ax_pdf_stream* stream); // and frees it
// `title` in UTF-8; `date` as "2026-05-31", anything else is left out.
ax_status ax_pdf_close(ax_pdf* pdf, const char* title, const char* date, const char* path, ax_error* error);
