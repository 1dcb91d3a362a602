// Failures that a reader of the page can do something about.

export class Failure extends Error {
  override readonly name = "Failure";
}

const CLASSES: Record<string, string> = {
  magic: "it is no welkin file",
  version: "it is of a version that this page does not know",
  feature: "it uses a feature that this page does not know",
  length: "it is shorter or longer than its head says",
  checksum: "a part of it is damaged (its checksum is wrong)",
  value: "it holds numbers that make no sense",
  encoding: "it is compressed; serve it without --zstd",
  missing: "it has no data for these conditions",
  range: "the conditions are out of its range",
  scratch: "there is not enough memory for it",
};

/** Of a class of errors that the reader names. */
export function unusable(name: string, url: string): Failure {
  return new Failure(`The model ${url} cannot be used: ${CLASSES[name] ?? name}.`);
}

export function message(error: unknown): string {
  if (error instanceof Error) return error.message;
  return String(error);
}
