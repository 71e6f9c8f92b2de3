// What documents and their states are, as the JSON of docs/protocol.md. New references, the caller's.
#pragma once

#include "ax/export.h"
#include "ax/report.h"
#include "ax/session.h"
#include "ax/target.h"
#include "studio/shape.h"

#include <jansson.h>

typedef struct describe_names {
    const char *id, *name, *path; // path: within the folder, NULL if there is none
} describe_names;

json_t* describe_document(const describe_names* names, const ax_session* s, const ax_form_report* report);
json_t* describe_linkage(const char* id, unsigned topology, const ax_form_view* view, const double origin[3],
                         const double flat_origin[2], const char* variant);
// The checks of "Can it deploy?", in their fixed order, and the verdict they add up to. What moves is not settled, and need not be.
json_t* describe_checks(const ax_form_report* report, const ax_form_view* view, const shape_measures* measures,
                        const ax_design* exact, bool at_rest);
json_t* describe_verdict(const json_t* checks);
json_t* describe_report(unsigned revision, const ax_form_report* report, const ax_form_view* view,
                        const shape_measures* measures, const ax_design* exact, bool at_rest);
json_t* describe_screen(const char* name, const ax_mesh* mesh, const ax_mesh_repairs* repairs, const ax_screen* screen);
json_t* describe_operators(void);
json_t* describe_exporters(void);
json_t* describe_making(void);                  // joints, materials, sheets, profiles
json_t* describe_plan(const ax_cut_plan* plan); // null if it is empty

json_t* describe_number(double x); // null if it is not finite
json_t* describe_point(const double x[3]);
