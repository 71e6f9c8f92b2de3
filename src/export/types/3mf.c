// 3MF core specification 1.3: every panel an object of its own, named by its id, a prism of the material's thickness about the panel's
// plane, in millimetres.
#include "base/vec.h"
#include "export/writing.h"

#include <minizip/zip.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char content_types[] =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n";
static const char relations[] =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

static void put_panel(FILE* out, const ax_design* design, int t, const double (*places)[3], double mm, double thickness)
{
    const int* h = design->linkage.triangles[t];
    char name[16];
    double normal[3];
    ax_panel_name(&design->linkage, t, name);
    ax_panel_normal(places, h, normal);
    fprintf(out, "<object id=\"%d\" type=\"model\" name=\"%s\"><mesh><vertices>\n", t + 1, name);
    for (int side = 0; side < 2; ++side)
        for (int k = 0; k < 3; ++k) {
            double p[3];
            for (int c = 0; c < 3; ++c)
                p[c] = mm * places[h[k]][c] + (side - 0.5) * thickness * normal[c];
            fprintf(out, "<vertex x=\"%.5f\" y=\"%.5f\" z=\"%.5f\"/>\n", p[0], p[1], p[2]);
        }
    fputs("</vertices><triangles>\n<triangle v1=\"0\" v2=\"2\" v3=\"1\"/>\n<triangle v1=\"3\" v2=\"4\" v3=\"5\"/>\n",
          out);
    for (int k = 0; k < 3; ++k) {
        int next = (k + 1) % 3;
        fprintf(out, "<triangle v1=\"%d\" v2=\"%d\" v3=\"%d\"/>\n<triangle v1=\"%d\" v2=\"%d\" v3=\"%d\"/>\n", k, next,
                next + 3, k, next + 3, k + 3);
    }
    fputs("</triangles></mesh></object>\n", out);
}

// The model as text, owned by the caller (free).
static char* compose(const ax_design* design, ax_state state, double thickness, size_t* size)
{
    char* text = NULL;
    FILE* out = open_memstream(&text, size);
    double(*places)[3] = ax_state_places(design, state), mm = 1000 * ax_unit_in_metres(design->unit);
    int count = design->linkage.triangle_count;
    char remark[80];
    ax_export_remark(design, state, remark);
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
            "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
            "<metadata name=\"Application\">%s</metadata>\n<resources>\n",
            remark);
    for (int t = 0; t < count; ++t)
        put_panel(out, design, t, (const double(*)[3])places, mm, thickness);
    fputs("</resources>\n<build>\n", out);
    for (int t = 0; t < count; ++t)
        fprintf(out, "<item objectid=\"%d\"/>\n", t + 1);
    fputs("</build>\n</model>\n", out);
    fclose(out);
    ax_free(places);
    return text;
}

static bool put_part(zipFile zip, const char* name, const char* text, size_t size)
{
    zip_fileinfo info = {.tmz_date = {.tm_mday = 1, .tm_year = 1980}}; // the same design gives the same bytes
    return zipOpenNewFileInZip(zip, name, &info, NULL, 0, NULL, 0, NULL, Z_DEFLATED, Z_DEFAULT_COMPRESSION) == ZIP_OK &&
           zipWriteInFileInZip(zip, text, (unsigned)size) == ZIP_OK && zipCloseFileInZip(zip) == ZIP_OK;
}

static ax_status write_3mf(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                           ax_error* error)
{
    const ax_fabricate_options standard = ax_fabricate_options_default();
    double thickness = (options->fabricate ? options->fabricate : &standard)->material.thickness;
    zipFile zip = zipOpen(path, APPEND_STATUS_CREATE);
    if (!zip)
        return ax_fail(error, AX_FAILED,
                       "%s could not be written. Is there room on the disk, and may the folder be written to?", path);
    size_t size;
    char* model = compose(design, state, thickness, &size);
    bool sound = put_part(zip, "[Content_Types].xml", content_types, strlen(content_types)) &&
                 put_part(zip, "_rels/.rels", relations, strlen(relations)) &&
                 put_part(zip, "3D/3dmodel.model", model, size);
    sound = zipClose(zip, NULL) == ZIP_OK && sound;
    free(model);
    return sound ? AX_OK : ax_fail(error, AX_FAILED, "%s could not be written. Is there room on the disk?", path);
}

const ax_export_type ax_export_3mf = {
    .ending = ".3mf",
    .name = "3MF model",
    .doc = "Panels as prisms of the material's thickness, each an object named by its id, in mm, for printing.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {true, true, true, true},
    .write = write_3mf,
};
