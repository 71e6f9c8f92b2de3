#include "export/pdf.h"

#include <ctype.h>
#include <iconv.h>
#include <stdarg.h>
#include <string.h>
#include <zlib.h>

enum { CATALOG = 1, PAGES, INFORMATION, FIRST };

static void put(ax_pdf* pdf, const char* format, ...) __attribute__((format(printf, 2, 3)));
static void put(ax_pdf* pdf, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    pdf->offset += vfprintf(pdf->out, format, arguments);
    va_end(arguments);
}

static void begin_object(ax_pdf* pdf, int number)
{
    pdf->objects[number - 1] = pdf->offset;
    put(pdf, "%d 0 obj\n", number);
}

static int new_object(ax_pdf* pdf)
{
    if (pdf->object_count == pdf->object_room) {
        pdf->object_room = 2 * pdf->object_room + 64;
        pdf->objects = ax_realloc(pdf->objects, (size_t)pdf->object_room, sizeof *pdf->objects);
    }
    begin_object(pdf, ++pdf->object_count);
    return pdf->object_count;
}

ax_status ax_pdf_open(ax_pdf* pdf, const char* path, ax_error* error)
{
    *pdf = (ax_pdf){.out = ax_export_open(path, error)};
    if (!pdf->out)
        return AX_FAILED;
    put(pdf, "%%PDF-1.4\n%%\xe2\xe3\xcf\xd3\n"); // bytes that tell programs not to take it for text
    pdf->object_room = pdf->object_count = FIRST - 1;
    pdf->objects = AX_NEW0(long long, pdf->object_room);
    return AX_OK;
}

void ax_pdf_page(ax_pdf* pdf, double width, double height, int streams)
{
    static const double points = 72 / 25.4;
    if (pdf->page_count == pdf->page_room) {
        pdf->page_room = 2 * pdf->page_room + 64;
        pdf->pages = ax_realloc(pdf->pages, (size_t)pdf->page_room, sizeof *pdf->pages);
    }
    int page = new_object(pdf);
    pdf->pages[pdf->page_count++] = page;
    put(pdf, "<</Type/Page/Parent %d 0 R/MediaBox[0 0 %.6f %.6f]/Resources<<>>/Contents[", PAGES, points * width,
        points * height);
    for (int k = 1; k <= streams; ++k)
        put(pdf, "%d 0 R ", page + k);
    put(pdf, "]>>\nendobj\n");
}

// Numbers deflate little better with more effort: level 1 takes a quarter of the usual time for a tenth more bytes.
ax_pdf_stream ax_pdf_deflate(ax_writer* content)
{
    uLongf size = compressBound(content->count);
    ax_pdf_stream stream = {.bytes = ax_alloc(size, 1)};
    compress2(stream.bytes, &size, (const Bytef*)content->at, content->count, 1);
    stream.size = size;
    ax_writer_free(content);
    return stream;
}

void ax_pdf_add(ax_pdf* pdf, ax_pdf_stream* stream)
{
    new_object(pdf);
    put(pdf, "<</Length %zu/Filter/FlateDecode>>\nstream\n", stream->size);
    pdf->offset += (long long)fwrite(stream->bytes, 1, stream->size, pdf->out);
    put(pdf, "\nendstream\nendobj\n");
    ax_free(stream->bytes);
    *stream = (ax_pdf_stream){0};
}

// A text string in UTF-16; what is not UTF-8 ends it.
static void put_text(ax_pdf* pdf, const char* text)
{
    char wide[512], *in = (char*)text, *out = wide;
    size_t left = strlen(text), room = sizeof wide;
    iconv_t convert = iconv_open("UTF-16BE", "UTF-8");
    iconv(convert, &in, &left, &out, &room);
    iconv_close(convert);
    put(pdf, "<FEFF");
    for (const char* c = wide; c < out; ++c)
        put(pdf, "%02X", (unsigned)(unsigned char)*c);
    put(pdf, ">");
}

static bool is_date(const char* date)
{
    for (int k = 0; k < 10; ++k)
        if (k == 4 || k == 7 ? date[k] != '-' : !isdigit((unsigned char)date[k]))
            return false;
    return date[10] == '\0';
}

ax_status ax_pdf_close(ax_pdf* pdf, const char* title, const char* date, const char* path, ax_error* error)
{
    begin_object(pdf, CATALOG);
    put(pdf, "<</Type/Catalog/Pages %d 0 R>>\nendobj\n", PAGES);
    begin_object(pdf, PAGES);
    put(pdf, "<</Type/Pages/Count %d/Kids[", pdf->page_count);
    for (int k = 0; k < pdf->page_count; ++k)
        put(pdf, "%d 0 R\n", pdf->pages[k]);
    put(pdf, "]>>\nendobj\n");
    begin_object(pdf, INFORMATION);
    put(pdf, "<</Creator(Auxshell)/Title");
    put_text(pdf, title);
    if (is_date(date))
        put(pdf, "/CreationDate(D:%.4s%.2s%.2s000000Z)", date, date + 5, date + 8);
    put(pdf, ">>\nendobj\n");
    long long start = pdf->offset;
    put(pdf, "xref\n0 %d\n0000000000 65535 f \n", pdf->object_count + 1);
    for (int k = 0; k < pdf->object_count; ++k)
        put(pdf, "%010lld 00000 n \n", pdf->objects[k]);
    put(pdf, "trailer\n<</Size %d/Root %d 0 R/Info %d 0 R>>\nstartxref\n%lld\n%%%%EOF\n", pdf->object_count + 1,
        CATALOG, INFORMATION, start);
    FILE* out = pdf->out;
    ax_free(pdf->objects);
    ax_free(pdf->pages);
    *pdf = (ax_pdf){0};
    return ax_export_close(out, path, error);
}
