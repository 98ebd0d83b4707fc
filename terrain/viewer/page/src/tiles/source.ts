/** Where the files of a tileset come from: a server, or a folder that was chosen. */

/** What cannot be read, in one sentence. */
export class TilesetError extends Error {}

const MOST_SHOWN = 120;

/** Gives the bytes of a file, named by its path from the folder of the tileset. */
export interface Source {
  /** The path of the tileset. */
  readonly root: string;
  read(path: string, signal: AbortSignal): Promise<ArrayBuffer>;
}

/** Return a name from a file, no longer than can be read. */
export function quote(name: string): string {
  return `'${name.length > MOST_SHOWN ? `${name.slice(0, MOST_SHOWN)}...` : name}'`;
}

/** Return the path to which one file of a tileset refers. Nothing outside the folder is named. */
export function resolve(from: string, uri: string): string {
  const outside = new TilesetError(
    `${from} names ${quote(uri)}, which lies outside the folder of the tileset: nothing else is asked for.`,
  );
  if (/^[a-z][a-z0-9+.-]*:/i.test(uri) || /^[\\/]/.test(uri)) throw outside;
  const [, way, query] = /^([^?#]*)(\?[^#]*)?/.exec(uri)!;
  const parts = from.split("?")[0].split("/").slice(0, -1);
  for (const part of way.split("/").map(decode)) {
    // A server takes each of them for what separates folders, too.
    if (/[\\/\0]/.test(part)) throw outside;
    if (part === "..") {
      if (parts.pop() === undefined) throw outside;
    } else if (part !== "" && part !== ".") parts.push(part);
  }
  if (parts.length === 0) throw new TilesetError(`${from} names a content without a name.`);
  return parts.join("/") + (query ?? "");
}

function decode(part: string): string {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}

/** Files beside the page, from the server that gave the page. */
export class WebSource implements Source {
  readonly root: string;
  private readonly folder: URL;

  constructor(address: string) {
    const whole = new URL(address, document.baseURI);
    this.folder = new URL(".", whole);
    this.root = decode(whole.pathname.split("/").pop() ?? "");
  }

  async read(path: string, signal: AbortSignal): Promise<ArrayBuffer> {
    const at = path.indexOf("?");
    const [way, query] = at < 0 ? [path, ""] : [path.slice(0, at), path.slice(at)];
    const address = new URL(way.split("/").map(encodeURIComponent).join("/") + query, this.folder);
    let answer: Response;
    try {
      answer = await fetch(address, { signal, credentials: "same-origin" });
    } catch (error) {
      if (signal.aborted) throw error;
      throw new TilesetError(`${path} cannot be read: the server does not answer.`);
    }
    if (!answer.ok)
      throw new TilesetError(`${path} cannot be read: the server answers ${answer.status} ${answer.statusText}.`.replace(" .", "."));
    return answer.arrayBuffer();
  }
}

/** Files of a folder that was chosen or dropped. */
export class FolderSource implements Source {
  readonly root: string;

  /** `files` by their paths; the tileset is the one of that name that lies highest. */
  constructor(
    private readonly files: Map<string, Blob>,
    name: string,
  ) {
    const found = [...files.keys()].filter((path) => path.split("/").pop() === name);
    const depth = (path: string): number => path.split("/").length;
    found.sort((a, b) => depth(a) - depth(b));
    if (found.length === 0)
      throw new TilesetError(`There is no ${quote(name)} among the ${files.size} files: choose the folder that has it.`);
    if (found.length > 1 && depth(found[0]) === depth(found[1]))
      throw new TilesetError(`There are several tilesets, ${quote(found[0])} and ${quote(found[1])}: choose the folder of one.`);
    this.root = found[0];
  }

  async read(path: string, signal: AbortSignal): Promise<ArrayBuffer> {
    const file = this.files.get(path) ?? this.files.get(path.split("?")[0]);
    if (file === undefined) throw new TilesetError(`${path} is missing in the folder.`);
    let bytes: ArrayBuffer;
    try {
      bytes = await file.arrayBuffer();
    } catch {
      throw new TilesetError(`${path} cannot be read.`);
    }
    signal.throwIfAborted();
    return bytes;
  }
}
