/** Asks for the folder of a tileset, where a browser lets no page read what lies beside it. */

import { find, makeText } from "../elements";
import { FolderSource, type Source, TilesetError } from "./source";

/** Wait for a folder that is chosen or dropped; `name` is that of the tileset in it. */
export function chooseFolder(words: string, name: string): Promise<Source> {
  const box = find<HTMLElement>("wait");
  const label = document.createElement("label");
  const input = document.createElement("input");
  Object.assign(input, { type: "file", id: "folder", multiple: true, webkitdirectory: true });
  label.append("Folder of the tileset ", input);
  box.replaceChildren(makeText("span", words), label);
  box.classList.add("asking");
  return new Promise((done) => {
    const take = (files: Map<string, Blob>): void => {
      try {
        const source = new FolderSource(files, name);
        stop.abort();
        box.classList.remove("asking");
        box.textContent = "Opening the terrain ...";
        done(source);
      } catch (error) {
        if (!(error instanceof TilesetError)) throw error;
        box.firstElementChild!.textContent = error.message;
      }
    };
    const stop = new AbortController();
    const { signal } = stop;
    input.addEventListener("change", () => {
      const files = [...(input.files ?? [])];
      take(new Map(files.map((file) => [file.webkitRelativePath || file.name, file])));
    }, { signal });
    document.addEventListener("dragover", (event) => event.preventDefault(), { signal });
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      const entries = [...(event.dataTransfer?.items ?? [])].map((item) => item.webkitGetAsEntry());
      void listFiles(entries).then(take);
    }, { signal });
  });
}

/** Return all files of what was dropped, by their paths. */
async function listFiles(entries: (FileSystemEntry | null)[]): Promise<Map<string, Blob>> {
  const files = new Map<string, Blob>();
  const stack = entries.filter((entry) => entry !== null);
  while (stack.length > 0) {
    const entry = stack.pop()!;
    if (entry.isFile) {
      const file = await new Promise<File>((done, fail) => (entry as FileSystemFileEntry).file(done, fail));
      files.set(entry.fullPath.replace(/^\//, ""), file);
      continue;
    }
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    // A hundred at a time, until none is left.
    for (;;) {
      const some = await new Promise<FileSystemEntry[]>((done, fail) => reader.readEntries(done, fail));
      if (some.length === 0) break;
      stack.push(...some);
    }
  }
  return files;
}
