/** A command line that cannot be meant as it stands; ends with exit code 2. */
export class UsageError extends Error {}
