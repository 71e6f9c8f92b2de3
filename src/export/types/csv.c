// Schedule of panels, hinges, sizes, parts and totals as comma separated values (RFC 4180): five tables, each with a heading, an empty
// line between them.
#include "export/writing.h"

#include "ax/cluster.h"

#include "base/vec.h"

#include <math.h>

static void put_number(FILE* out, double value, int digits)
{
    putc(',', out);
    if (isfinite(value))
        fprintf(out, "%.*f", digits, value);
}

static void put_panels(FILE* out, const ax_design* design, const ax_cut_plan* plan, const ax_clusters* clusters)
{
    double mm = 1000 * ax_unit_in_metres(design->unit);
    fputs("panel,index,edge 0 mm,edge 1 mm,edge 2 mm,lambda,area mm2,mass g,sheet,piece,row,layer,size\r\n", out);
    for (int t = 0; t < plan->panel_count; ++t) {
        const ax_cut_panel* p = plan->panels + t;
        const int* h = design->linkage.triangles[t];
        fprintf(out, "%s,%d", p->name, t);
        for (int k = 0; k < 3; ++k)
            put_number(out, mm * ax_distance2(design->flat[h[(k + 1) % 3]], design->flat[h[(k + 2) % 3]]), 3);
        put_number(out, design->scale[t], 4);
        put_number(out, p->area, 2);
        put_number(out, 1000 * p->mass, 3);
        fprintf(out, ",%d,%d,%d,%d,%d\r\n", p->sheet + 1, p->piece + 1, p->row, p->layer + 1, clusters->size_of[t] + 1);
    }
}

static void put_hinges(FILE* out, const ax_cut_plan* plan)
{
    fputs("\r\nhinge,panel,panel,seam,flat mouth deg,clearance mm,force N,rated N\r\n", out);
    for (int k = 0; k < plan->hinge_count; ++k) {
        const ax_cut_hinge* h = plan->hinges + k;
        fprintf(out, "%d,%s,%s,", h->hinge, plan->panels[h->panels[0]].name, plan->panels[h->panels[1]].name);
        if (h->seam)
            fprintf(out, "%d", h->seam);
        put_number(out, h->mouth * 180 / AX_PI, 2);
        put_number(out, h->clearance, 3);
        put_number(out, h->force, 3);
        put_number(out, h->rated, 1);
        fputs("\r\n", out);
    }
}

static void put_sizes(FILE* out, const ax_clusters* clusters)
{
    fputs("\r\nsize,panels,edge 0 mm,edge 1 mm,edge 2 mm,error mm\r\n", out);
    for (int s = 0; s < clusters->size_count; ++s) {
        const ax_panel_size* size = clusters->sizes + s;
        fprintf(out, "%d,%d", s + 1, size->count);
        for (int k = 0; k < 3; ++k)
            put_number(out, size->edges[k], 3);
        put_number(out, size->error, 4);
        fputs("\r\n", out);
    }
}

static void put_totals(FILE* out, const ax_cut_plan* plan, const ax_clusters* clusters)
{
    fputs("\r\npart,count\r\n", out);
    for (int k = 0; k < plan->part_count; ++k)
        fprintf(out, "\"%s\",%d\r\n", plan->parts[k].name, plan->parts[k].count);
    fputs("\r\ntotal,value,unit\r\n", out);
    fprintf(out, "panels,%d,\r\nhinges,%d,\r\nsheets,%d,\r\nseams,%d,\r\n", plan->panel_count, plan->hinge_count,
            plan->sheet_count, plan->seam_count);
    fprintf(out, "material area,%.6f,m2\r\nmass,%.4f,kg\r\nutilisation,%.4f,\r\n", plan->area * 1e-6, plan->mass,
            plan->utilisation);
    for (int k = 0; k < AX_OPERATIONS; ++k)
        if (k != AX_NOTE)
            fprintf(out, "%s length,%.4f,m\r\n", ax_operation_name((ax_operation)k), plan->cut_length[k] * 1e-3);
    fprintf(out, "machine time,%.0f,s\r\ncollisions,%d,\r\n", plan->seconds, plan->clashes_found);
    fprintf(out, "sizes,%d,\r\nsizes: largest edge error,%.4f,mm\r\nsizes: rms edge error,%.4f,mm\r\n",
            clusters->size_count, clusters->edge_max, clusters->edge_rms);
    fprintf(out, "sizes: largest gap at a hinge,%.4f,mm\r\nsizes: largest change of a line,%.4f,mm\r\n",
            clusters->gap_max, clusters->line_max);
}

static ax_status write_sheet(const ax_design* design, const ax_cut_plan* plan, int sheet, const char* path,
                             ax_error* error)
{
    (void)sheet;
    if (!design)
        return ax_fail(error, AX_USAGE, "A coupon has no schedule; write it as .svg, .dxf or .pdf.");
    FILE* out = ax_export_open(path, error);
    if (!out)
        return AX_FAILED;
    ax_clusters clusters =
        plan->sizes ? ax_cluster_panels(design, plan->sizes) : ax_cluster_within(design, AX_CLUSTER_TOLERANCE);
    put_panels(out, design, plan, &clusters);
    put_hinges(out, plan);
    put_sizes(out, &clusters);
    put_totals(out, plan, &clusters);
    ax_clusters_free(&clusters);
    return ax_export_close(out, path, error);
}

const ax_export_type ax_export_csv = {
    .ending = ".csv",
    .name = "Schedule",
    .doc = "Panels with edges, lambda, mass, sheet, row and size; hinges with forces and clearance; sizes, parts and "
           "totals.",
    .default_state = AX_STATE_FLAT,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_FLAT] = true},
    .write_sheet = write_sheet,
    .all_sheets = true,
};
