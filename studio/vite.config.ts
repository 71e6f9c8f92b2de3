import { defineConfig } from "vitest/config";

// For development against a running studio: AUXSHELL_STUDIO holds the address that `auxshell studio` printed.
const studio = process.env.AUXSHELL_STUDIO ? new URL(process.env.AUXSHELL_STUDIO) : null;
const to = studio && { target: studio.origin, changeOrigin: true, headers: { origin: studio.origin } };

// The server embeds dist/ as it stands and serves it under a policy without inline script or style: nothing is inlined.
export default defineConfig({
    base: studio ? studio.pathname : "./",
    oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
    build: { target: "es2022", assetsInlineLimit: 0, modulePreload: { polyfill: false }, chunkSizeWarningLimit: 1200 },
    worker: { format: "es" },
    server: {
        host: "127.0.0.1",
        proxy: studio && to ? { "/ws": { ...to, ws: true }, [`${studio.pathname}upload`]: to, [`${studio.pathname}file`]: to } : {},
    },
    test: { include: ["test/**/*.test.ts"], environment: "node" },
});
