// The library as an ES module, which its own types leave out.
declare module "rhino3dm/rhino3dm.module.js" {
    import type { RhinoModule } from "rhino3dm";
    export default function load(options?: { locateFile?: (file: string) => string }): Promise<RhinoModule>;
}
