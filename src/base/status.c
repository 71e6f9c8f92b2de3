#include "ax/base.h"

#include <stdarg.h>
#include <stdio.h>

ax_status ax_fail(ax_error* error, ax_status status, const char* format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        error->status = status;
        vsnprintf(error->message, sizeof error->message, format, arguments);
        va_end(arguments);
    }
    return status;
}

bool ax_progress_report(const ax_progress* progress, const char* stage, double fraction, double residual)
{
    return !progress || !progress->report || progress->report(progress->context, stage, fraction, residual);
}

static bool report_part(void* context, const char* stage, double fraction, double residual)
{
    const ax_progress_part* slot = context;
    return ax_progress_report(slot->whole, stage, slot->lo + (slot->hi - slot->lo) * fraction, residual);
}

const ax_progress* ax_progress_within(ax_progress_part* slot, const ax_progress* whole, double lo, double hi)
{
    if (!whole)
        return NULL;
    *slot = (ax_progress_part){.whole = whole, .lo = lo, .hi = hi, .part = {report_part, slot}};
    return &slot->part;
}

const char* ax_version(void)
{
    return AX_VERSION;
}
