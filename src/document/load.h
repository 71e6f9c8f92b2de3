// Loading under another schema than this program's own: how upgrading is tested before there is anything to upgrade.
#pragma once

#include "ax/document.h"
#include "document/schema.h"

ax_status ax_document_load_as(const ax_schema* schema, const char* path, ax_design* design, ax_error* error);
